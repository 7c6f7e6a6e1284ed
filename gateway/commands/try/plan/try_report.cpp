// SPDX-License-Identifier: Apache-2.0
#include "gateway/commands/try/plan/try_report.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace axisgate::commands {
namespace {

struct StepText {
  std::string_view name, will, needs;
};

constexpr std::array<StepText, kTrySteps> kTexts{{
    {"read", "read every object of the profile once; nothing is written", "the drive on, the gateway off"},
    {"setup", "bring the drive up as the gateway does, and read back what that wrote",
     "nothing else that talks to the drive"},
    {"turn", "count what one turn of the shaft comes to", "a shaft without torque that can be turned"},
    {"torque", "enable, hold for 2 s, disable", "nobody touches the shaft: it must not move by 1 % of a turn"},
    {"moves",
     "a twentieth of a turn, one turn and one back, at 10 rpm; then 30 rpm for 2 s. The drive is stopped and disabled "
     "after each",
     "two turns free on either side, the wired stop in reach"},
    {"stops", "turn at 30 rpm and stop: by quick stop, by halt, by disable",
     "three turns free on either side, the wired stop in reach"},
    {"loss", "turn at 30 rpm and withhold the gateway's heartbeats: the drive must stop by itself",
     "three turns free on either side, the wired stop in reach"},
    {"home", "home with the method of --home at 10 rpm, for a minute at most",
     "the way to the switch or stop free, the wired stop in reach"},
}};

const StepText& texts_of(TryStep step) { return kTexts[static_cast<std::size_t>(step)]; }

nlohmann::ordered_json number_or_null(const std::optional<std::int64_t>& number) {
  return number ? nlohmann::ordered_json(*number) : nlohmann::ordered_json();
}

}  // namespace

std::string_view text(TryStep step) { return texts_of(step).name; }
std::string_view will(TryStep step) { return texts_of(step).will; }
std::string_view needs(TryStep step) { return texts_of(step).needs; }

std::string_view text(Verdict verdict) {
  if (verdict == Verdict::right) return "right";
  return verdict == Verdict::wrong ? "wrong" : "not tried";
}

bool TryReport::any_wrong() const {
  return std::ranges::any_of(steps, [](const StepReport& step) { return step.verdict == Verdict::wrong; });
}

std::string json_text(const TryReport& report) {
  nlohmann::ordered_json out{
      {"report", 1},         {"axisgate", report.version}, {"at", report.at},       {"config", report.config},
      {"axis", report.axis}, {"profile", report.profile},  {"title", report.title}, {"protocol", report.protocol},
      {"dry", report.dry},   {"ended", report.ended}};
  nlohmann::ordered_json& steps = out["steps"] = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < kTrySteps; ++i)
    steps.push_back({{"step", kTexts[i].name},
                     {"will", kTexts[i].will},
                     {"needs", kTexts[i].needs},
                     {"saw", report.steps[i].saw},
                     {"verdict", text(report.steps[i].verdict)}});
  nlohmann::ordered_json& objects = out["objects"] = nlohmann::ordered_json::array();
  for (const ObjectRow& row : report.objects)
    objects.push_back({{"name", row.name},
                       {"at", row.address},
                       {"type", row.type},
                       {"value", number_or_null(row.value)},
                       {"other_word_order", number_or_null(row.other_order)},
                       {"remark", row.remark}});
  return out.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

std::vector<std::string> wrapped(std::string_view text, std::size_t indent, std::size_t width) {
  std::vector<std::string> out;
  std::string begin;
  while (begin.size() + text.size() > width) {
    const std::size_t room = width - begin.size();
    std::size_t cut = text.rfind(' ', room);
    if (cut == std::string_view::npos || cut < room / 3) cut = text.find(' ', room);
    if (cut == std::string_view::npos) break;
    out.push_back(begin + std::string(text.substr(0, cut)));
    text.remove_prefix(cut + 1);
    begin.assign(indent, ' ');
  }
  out.push_back(begin + std::string(text));
  return out;
}

}  // namespace axisgate::commands
