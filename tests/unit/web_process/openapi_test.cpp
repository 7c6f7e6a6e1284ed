// SPDX-License-Identifier: Apache-2.0
// openapi.json against the real answers: every answer is as it says, it says every answer, and every member that it
// promises comes.
#include <gmock/gmock.h>

#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validator.hpp>

#include "gateway/upstream/web_process/api/openapi_text.hpp"
#include "gateway/upstream/web_process/stream/stream.hpp"
#include "tests/unit/web_process/told.hpp"

namespace axisgate::web {
namespace {

using Schema = nlohmann::json;

const Schema& openapi() {
  static const Schema kAll = Schema::parse(openapi_text());
  return kAll;
}

/// With what each $ref means in its place. No schema here refers to itself.
Schema expanded(const Schema& schema) {
  if (schema.is_object() && schema.contains("$ref"))
    return expanded(openapi().at(Schema::json_pointer(schema["$ref"].get<std::string>().substr(1))));
  Schema out = schema;
  if (schema.is_structured())
    for (auto& each : out) each = expanded(each);
  return out;
}

/// Members that the answer has and the schema does not name, or does not have and must: what is wrong, in words.
std::string mistakes(const Schema& schema, const Schema& answer) {
  valijson::Schema parsed;
  const Schema whole = expanded(schema);
  const valijson::adapters::NlohmannJsonAdapter schema_adapter(whole);
  valijson::SchemaParser(valijson::SchemaParser::kDraft7).populateSchema(schema_adapter, parsed);
  valijson::ValidationResults results;
  valijson::Validator validator;
  if (validator.validate(parsed, valijson::adapters::NlohmannJsonAdapter(answer), &results)) return "";
  std::string out;
  for (const auto& each : results) {
    for (const std::string& part : each.context) out += part;
    out += ": " + each.description + "\n";
  }
  return out;
}

/// A gateway of which everything was told that an answer can tell.
class Everything {
 public:
  Everything() {
    AxisSample sample = standing(1);
    told.tell(sample);  // that it faults later makes a capture
    sample.axis_state = static_cast<std::uint8_t>(AxisState::error_stop);
    sample.inputs = bits_of({AxisInput::online, AxisInput::fault});
    sample.alarms = bit(AxisAlarm::stop_latched);
    sample.valid &= ~bit(Quantity::position_actual);
    sample.owner = sample.result_who = "10.0.0.2:5000";
    sample.lease_ms = sample.result_age_ms = 100;
    sample.result_what = "enable";
    told.tell(sample);
    StatisticsRecord told_of = statistics();
    told_of.alarms = 1;
    told.tell(told_of);
    CountsRecord counts;
    counts.at = told_of.at;
    counts.buses.resize(1);
    told.tell(counts);
    counts.at += kSecond;
    counts.buses[0].times[5].counts[3] = 10;
    told.tell(counts);
    EventRecord event;
    event.number = 1;
    event.axis = 1;
    told.tell(event);
  }
  Told told;
};

Schema schema_of(const std::string& path, unsigned status = 200, const std::string& type = "application/json") {
  const Schema& responses = openapi()["paths"].at(path)["get"]["responses"];
  const std::string key = std::to_string(status);
  return expanded(responses.contains(key) ? responses[key] : responses["default"])["content"][type]["schema"];
}

struct Example {
  std::string path;  ///< as openapi.json has it
  std::string target;
};

const std::vector<Example>& examples() {
  static const std::vector<Example> kExamples{{"/api/v1/gateway", "/api/v1/gateway"},
                                              {"/api/v1/buses", "/api/v1/buses"},
                                              {"/api/v1/buses/{name}", "/api/v1/buses/serial"},
                                              {"/api/v1/axes", "/api/v1/axes"},
                                              {"/api/v1/axes/{axis}", "/api/v1/axes/1"},
                                              {"/api/v1/events", "/api/v1/events"},
                                              {"/api/v1/words", "/api/v1/words"},
                                              {"/api/v1/explain", "/api/v1/explain?q=0x3210"},
                                              {"/api/v1/map", "/api/v1/map"},
                                              {"/api/v1/health", "/api/v1/health"},
                                              {"/api/v1/history", "/api/v1/history?series=1.position_rev"},
                                              {"/api/v1/captures", "/api/v1/captures"},
                                              {"/api/v1/captures/{id}", "/api/v1/captures/42.10000"},
                                              {"/api/v1/openapi.json", "/api/v1/openapi.json"}};
  return kExamples;
}

TEST(Openapi, SaysHowEveryAnswerIs) {
  Everything all;
  for (const SteadyNs later : {SteadyNs{0}, 10 * kSecond})
    for (const Example& each : examples()) {
      const Answer answer = asked(all.told, each.target, later);
      const unsigned status = status_of(answer);
      EXPECT_EQ(mistakes(schema_of(each.path, status), Schema::parse(std::get<Response>(answer.what).body())), "")
          << each.target << " " << status;
    }
}

TEST(Openapi, SaysHowARefusalIs) {
  Told told;
  const Answer answer = asked(told, "/api/v1/axes?x=1");
  EXPECT_EQ(mistakes(schema_of("/api/v1/axes", 400, "application/problem+json"),
                     Schema::parse(std::get<Response>(answer.what).body())),
            "");
}

TEST(Openapi, HasEveryPathThatIsAnswered) {
  for (const auto& [path, of_path] : openapi()["paths"].items())
    EXPECT_TRUE(path == "/api/v1/stream" || path.ends_with(".csv") ||
                std::ranges::find(examples(), path, &Example::path) != examples().end())
        << path;
  EXPECT_EQ(openapi()["paths"].size(), examples().size() + 3);
}

TEST(Openapi, NamesTheParametersThatAreTaken) {
  Everything all;
  for (const auto& [path, of_path] : openapi()["paths"].items()) {
    std::string named;
    for (const Schema& each : expanded(of_path["get"].value("parameters", Schema::array())))
      if (each["in"] == "query") named += (named.empty() ? "" : ", ") + each["name"].get<std::string>();
    std::string target = path;
    if (const auto example = std::ranges::find(examples(), path, &Example::path); example != examples().end())
      target = example->target.substr(0, example->target.find('?'));
    if (path == "/api/v1/captures/{id}.csv") target = "/api/v1/captures/42.10000.csv";
    const std::string needed = named.starts_with("series") && path != "/api/v1/stream" ? "&series=1.position_rev" : "";
    const std::string detail = body_of(asked(all.told, target + "?unknown=1" + needed))["detail"].get<std::string>();
    EXPECT_EQ(detail, named.empty() ? "unknown: there are no parameters here"
                                    : "unknown: there is no such parameter; there are: " + named)
        << path;
  }
}

TEST(Openapi, SaysHowTheEventsOfAStreamAre) {
  Everything all;
  StreamRequest request;
  request.after = 0;
  request.series = {{1, static_cast<std::uint8_t>(Quantity::velocity_actual)}};
  Stream stream(request, all.told.picture(), kStarted);
  Feed feed;
  const Schema& events = openapi()["paths"]["/api/v1/stream"]["get"]["responses"]["200"]["x-events"];
  std::set<std::string> seen;
  const auto look = [&](const std::string& text) {
    std::istringstream in(text);
    std::string event;
    for (std::string line; std::getline(in, line);) {
      if (line.starts_with("event: ")) event = line.substr(7);
      if (!line.starts_with("data: ")) continue;
      seen.insert(event);
      EXPECT_EQ(mistakes(events.at(event), Schema::parse(line.substr(6))), "") << event;
    }
  };
  for (const SteadyNs later : {SteadyNs{0}, kSecond, 5 * kSecond, 7 * kSecond}) {
    feed.update(all.told.picture(), Served{}, at(later));
    look(stream.next(all.told.stores(), feed, at(later)));
    static_cast<void>(all.told.stores().turn(at(later + kSecond)));  // one capture is complete
  }
  look(Stream::bye("why"));
  EXPECT_EQ(seen.size(), events.size()) << "each of them came";
}

}  // namespace
}  // namespace axisgate::web
