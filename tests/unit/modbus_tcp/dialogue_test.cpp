// SPDX-License-Identifier: Apache-2.0
// Dialogues of clients with a desk, told in text files of dialogues/ and played step by step: each a test.
// Promises that every step says what happens or what is seen, and that a step that it does not understand fails.
// Never moves time but by the step that says so.
//
//   == a sentence               begins a dialogue; its steps stand below, parted by ";"; "#" begins a comment
//   154 = 0006                  FC 6 of one register, FC 16 of more; ":=" is FC 16 of one as well
//   coil 6 = 1   coils = 71     FC 5 of axis 1's coil; FC 15 of its first 8 (one byte) or 10 coils (two bytes)
//   jog 10                      FC 15 of its jog coils, forward 1 and reverse 0
//   16 008C FFEF 0010           any other PDU in hex
//   ... -> ok                   what comes back at once: "ok" done, "06" an exception, "wait" nothing yet, "0602.."
//   these bytes 125 reads 000A              FC 3, of as many registers as are told panel 154 = 0006 -> ok      as
//   another client: panel, viewer, tool, other (all at one address); else as the PLC asked enable, nothing       all
//   that the port was given since the last time, as Desk::asked() tells it next offline 5              the port's next
//   result, given at once; "next = 0637": of a read; "next text": of a longer one done timed_out   2nd = 07   what has
//   waited longest, or second longest, ends reply ok                    the next reply that has come by now +100ms
//   panel leaves       time passes; a connection ends slow, lacks max_torque      the rest is in Player::setting(): how
//   port, listener and axis 1 are, or what is counted
//   logged -, logged some, logged a line      what was logged at info and above since the last time
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "tests/places.hpp"
#include "tests/unit/modbus_tcp/support/desk.hpp"

namespace axisgate::modbus_tcp::test {
namespace {

struct Dialogue {
  std::string sentence;
  std::string file;
  struct Step {
    int line;
    std::string text;
  };
  std::vector<Step> steps;
};
void PrintTo(const Dialogue& dialogue, std::ostream* out) { *out << dialogue.sentence; }

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(' ');
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(' ') - first + 1);
}

std::vector<std::string> parted(const std::string& text, char by) {
  std::vector<std::string> out;
  std::istringstream stream(text);
  for (std::string each; std::getline(stream, each, by);)
    if (!trimmed(each).empty()) out.push_back(trimmed(each));
  return out;
}

std::string packed(std::string hex) {
  std::erase(hex, ' ');
  return hex;
}

Errc errc_named(const std::string& name) {
  static const std::map<std::string, Errc> kNames{{"done", Errc::ok},
                                                  {"bad_value", Errc::bad_value},
                                                  {"not_supported", Errc::not_supported},
                                                  {"role_forbidden", Errc::role_forbidden},
                                                  {"state_unsuitable", Errc::state_unsuitable},
                                                  {"queue_full", Errc::queue_full},
                                                  {"superseded", Errc::superseded},
                                                  {"not_owner", Errc::not_owner},
                                                  {"offline", Errc::offline},
                                                  {"refused_by_drive", Errc::refused_by_drive},
                                                  {"timed_out", Errc::timed_out},
                                                  {"not_new", Errc::not_new}};
  return kNames.at(name);
}

unsigned command_bit(const std::string& name) {
  for (unsigned command = 1; command <= kLastCommand; ++command)
    if (text(static_cast<Command>(command)) == name) return 1U << command;
  ADD_FAILURE() << "no such command: " << name;
  return 0;
}

Role role_of_client(const std::string& name) {
  if (name == "viewer") return Role::viewer;
  return name == "panel" || name == "tool" ? Role::operator_ : Role::engineer;
}

class Player {
 public:
  void step(const std::string& whole) {
    const auto words = parted(whole, ' ');
    static constexpr const char* kOthers[] = {"panel", "viewer", "tool", "other"};
    const bool named = std::find(std::begin(kOthers), std::end(kOthers), words[0]) != std::end(kOthers);
    if (words[0] == "asked") {
      EXPECT_EQ(desk_.asked(), trimmed(whole.substr(5)));
    } else if (words[0] == "logged") {
      const std::string lines = desk_.logged();
      if (words[1] == "some")
        EXPECT_NE(lines, "-");
      else
        EXPECT_EQ(lines, trimmed(whole.substr(6)));
    } else if (words[0] == "next") {
      desk_.port.at_once.push_back(result_of(words));
    } else if (words[0] == "done") {
      desk_.port.finish_with(result_of(words));
    } else if (words[0].ends_with("nd") || words[0].ends_with("th")) {
      desk_.port.finish_with(result_of(words), std::stoul(words[0]) - 1);
    } else if (words[0][0] == '+') {
      pass(std::stoi(words[0]) * (words[0].ends_with("ms") ? Duration(1ms) : Duration(1s)));
    } else if (!setting(words)) {
      speak(named ? words[0] : "plc", named ? trimmed(whole.substr(words[0].size())) : whole);
    }
  }

 private:
  /// "done", "next refused_by_drive 3 abort 08000000", "next bad_value row 42", "done = DEADBEEF", "next text
  /// axisdrive".
  static BatchResult result_of(const std::vector<std::string>& words) {
    const auto number = [&](std::size_t at) {
      return words.size() > at ? static_cast<std::uint32_t>(std::stoul(words[at], nullptr, 16)) : 0U;
    };
    BatchResult result;
    if (words.size() < 2) return result;
    if (words[1] == "=") return {{}, number(2), static_cast<std::uint8_t>(words.at(2).size() / 2)};
    if (words[1] == "text") {
      const std::string content = words.size() > 2 ? words[2] : "";
      result.object_bytes = std::make_shared<const std::vector<Byte>>(content.begin(), content.end());
    } else if (words.size() > 3 && words[2] == "row") {
      result.outcome.code = errc_named(words[1]);
      result.refused_row = static_cast<std::uint16_t>(std::stoi(words[3]));
    } else {
      result.outcome = {errc_named(words[1]), number(2)};
      result.abort_code = number(4);
    }
    return result;
  }

  /// "slow", "lacks max_torque", "gone 1": false where it is none.
  bool setting(const std::vector<std::string>& words) {
    AxisImage& axis = desk_.axis(1);
    const auto number = [&](std::size_t at = 1) { return std::stoll(words.at(at)); };
    const auto hex = [&](std::size_t at = 1) { return std::stoul(words.at(at), nullptr, 16); };
    const auto quantity = [&] { return quantity_named(words.at(1)).value(); };
    const std::map<std::string, std::function<void()>> settings{
        {"slow", [&] { desk_.port.slow = true; }},
        {"fast", [&] { desk_.port.slow = false; }},
        {"posted", [&] { desk_.settings.posted_writes = true; }},
        {"by-address", [&] { desk_.settings.client_is_address = true; }},
        {"per-axis", [&] { desk_.settings.per_axis_units = true; }},
        {"low-first", [&] { desk_.settings.low_word_first = true; }},
        {"float", [&] { desk_.settings.float_numbers = true; }},
        {"staged", [&] { desk_.settings.staged_halves = true; }},
        {"units", [&] { axis.units_per_rev = Rational(number(), number(2)); }},
        {"offline-reads-fail", [&] { desk_.settings.offline_reads_fail = true; }},
        {"unit", [&] { unit_ = static_cast<std::uint8_t>(number()); }},
        {"add", [&] { desk_.image.add_axis(static_cast<AxisNumber>(number()), "far", 0); }},
        {"offline", [&] { axis.link_state = LinkState::offline; }},
        {"faulted", [&] { axis.record.faulted(); }},
        {"lacks", [&] { axis.supported &= ~bit(quantity()); }},
        {"fixed", [&] { axis.writable &= ~bit(quantity()); }},
        {"unknown", [&] { axis[quantity()].received = false; }},
        {"shows", [&] { axis[quantity()].value = number(2); }},
        {"holds",
         [&] {
           desk_.port.cached.insert({1, quantity(), number(2)});
         }},
        {"limit",
         [&] {
           axis.limits[static_cast<std::size_t>(quantity())] = {number(2), number(3)};
         }},
        {"cannot", [&] { axis.supported_commands &= ~command_bit(words.at(1)); }},
        {"jogs", [&] { axis.jog_velocity = static_cast<std::uint32_t>(number()); }},
        {"set-position", [&] { desk_.port.set_positions[1] = static_cast<std::int32_t>(number()); }},
        {"level-coils", [&] { axis.level_coils = static_cast<std::uint16_t>(hex()); }},
        {"inputs", [&] { axis.inputs = static_cast<std::uint16_t>(hex()); }},
        {"latest",
         [&] {
           axis.latest = {static_cast<CommandResult>(number()), static_cast<std::uint32_t>(hex(2)),
                          static_cast<std::uint16_t>(number(3))};
         }},
        {"gone", [&] { EXPECT_EQ(desk_.port.gone.size(), static_cast<std::size_t>(number())); }},
        {"unanswered", [&] { EXPECT_EQ(desk_.registry.counters.unanswered, number()); }},
        {"told", [&] { EXPECT_EQ(client("plc").told, number()); }},
        {"listens", [&] { EXPECT_EQ(client("plc").session().wants_input(), words.at(1) == "yes"); }},
    };
    const auto found = settings.find(words[0]);
    if (found != settings.end()) found->second();
    return found != settings.end();
  }

  void pass(Duration time) {
    desk_.runtime.advance_by(time);
    if (!desk_.settings.staged_halves) return;  // no deadline but that of a half is looked at here
    for (const auto& [name, line] : clients_)
      if (line->session().next_deadline() <= desk_.runtime.now()) line->session().on_deadline(desk_.runtime.now());
  }

  Line& client(const std::string& name) {
    auto& line = clients_[name];
    if (!line) line = std::make_unique<Line>(desk_, role_of_client(name), name == "plc" ? kPlc : kPanel);
    return *line;
  }

  void speak(const std::string& name, const std::string& said) {
    Line& line = client(name);
    const auto arrow = said.find("->");
    const auto reads = said.find("reads");
    if (said == "leaves") {
      line.session().on_closed(desk_.runtime.now());
      clients_.erase(name);
    } else if (said.starts_with("bytes ")) {
      line.feed(bytes(said.substr(6)));
    } else if (said.starts_with("reply ")) {
      expect(line.reply(), said.substr(6));
    } else if (reads != std::string::npos) {
      const std::string expected = packed(said.substr(reads + 5));
      const auto address = static_cast<std::uint16_t>(std::stoi(said));
      EXPECT_EQ(packed(line.read(address, static_cast<std::uint16_t>(expected.size() / 4), unit_)), expected);
    } else {
      line.send(pdu_of(trimmed(said.substr(0, arrow))), unit_);
      if (arrow != std::string::npos) expect(line.reply(), said.substr(arrow + 2));
    }
  }

  static std::string pdu_of(const std::string& request) {
    if (request.starts_with("jog "))
      return "0F 006C 0002 01" + word((request[4] - '0') + 2 * (request[5] - '0')).substr(3);
    const auto equals = request.find('=');
    if (equals == std::string::npos) return request;
    const std::string value = packed(request.substr(equals + 1));
    if (request.starts_with("coils ")) {
      EXPECT_LE(value.size(), 4U) << "8 or 10 coils";
      return std::string("0F 0064") + (value.size() == 2 ? "0008 01" : "000A 02") + value;
    }
    if (request.starts_with("coil "))
      return "05" + word(100 + std::stoi(request.substr(5))) + word(value == "1" ? 0xFF00 : 0);
    const auto address = static_cast<std::uint16_t>(std::stoi(request));
    if (value.size() == 4 && request[equals - 1] != ':') return "06" + word(address) + value;
    return Line::block_write(address, value, value.size() / 4);
  }

  static void expect(const std::string& reply, const std::string& expected) {
    const std::string wanted = packed(expected);
    if (wanted == "ok") {
      EXPECT_TRUE(is_done(reply)) << '"' << reply << '"';
    } else if (wanted == "wait") {
      EXPECT_EQ(reply, "");
    } else if (wanted.size() == 2) {
      EXPECT_TRUE(is_exception(reply, std::stoi(wanted, nullptr, 16))) << '"' << reply << '"';
    } else {
      EXPECT_EQ(packed(reply), wanted);
    }
  }

  Desk desk_;
  std::map<std::string, std::unique_ptr<Line>> clients_;
  std::uint8_t unit_ = 1;
};

std::vector<Dialogue> all_dialogues() {
  std::vector<Dialogue> all;
  for (const auto& entry :
       std::filesystem::directory_iterator(axisgate::test::source_path("tests/unit/modbus_tcp/dialogues"))) {
    std::ifstream file(entry.path());
    int number = 0;
    for (std::string line; std::getline(file, line);) {
      ++number;
      if (line.starts_with("== ")) {
        all.push_back({line.substr(3), entry.path().string(), {}});
        continue;
      }
      for (const std::string& step : parted(line.substr(0, line.find('#')), ';'))
        all.back().steps.push_back({number, step});
    }
  }
  std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.sentence < b.sentence; });
  return all;
}

std::string name_of(const ::testing::TestParamInfo<Dialogue>& info) {
  std::string name = info.param.sentence;
  std::replace_if(
      name.begin(), name.end(), [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  return name;
}

class Dialogues : public ::testing::TestWithParam<Dialogue> {};

TEST_P(Dialogues, goes_as_it_is_told) {
  ASSERT_FALSE(GetParam().steps.empty());
  Player player;
  for (const auto& [line, step] : GetParam().steps) {
    SCOPED_TRACE(GetParam().file + ":" + std::to_string(line) + ": " + step);
    player.step(step);
  }
}

INSTANTIATE_TEST_SUITE_P(Modbus, Dialogues, ::testing::ValuesIn(all_dialogues()), name_of);

}  // namespace
}  // namespace axisgate::modbus_tcp::test
