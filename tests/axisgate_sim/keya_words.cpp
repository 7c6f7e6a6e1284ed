// SPDX-License-Identifier: Apache-2.0
#include "tests/axisgate_sim/keya_words.hpp"

#include <algorithm>

#include "tests/simulated/keya_parameters.hpp"

namespace axisgate::simulated {
namespace {

constexpr std::int64_t longest_heartbeat_ms = 60000;
constexpr std::size_t digits_of_a_number = 4;

bool modify_reading(KeyaOptions& drive, std::string_view word) {
  if (word == "coast") {
    drive.loss_stop = KeyaStop::coast;
  } else if (word == "ramp") {
    drive.loss_stop = KeyaStop::ramp;
  } else if (word == "queries-feed") {
    drive.queries_feed_watchdog = true;
  } else if (word == "repeat-ignored") {
    drive.repeated_move_moves = false;
  } else if (word == "zero-ignored") {
    drive.enable_with_zero_moves = false;
  } else if (word == "other-kept") {
    drive.code_disables_other = false;
  } else if (word == "sub-00") {
    drive.echoes_sub = false;
  } else if (word == "keeps-counts") {
    drive.keeps_counts = true;
  } else if (word == "period-only") {
    drive.pdo_on_change = false;
  } else {
    return false;
  }
  return true;
}

}  // namespace

void modify_keya(KeyaOptions& drive, std::string_view word) {
  if (modify_reading(drive, word)) return;
  const std::size_t equals = std::min(word.find('='), word.size());
  const std::string_view name = word.substr(0, equals);
  const auto value = whole_number(word.substr(std::min(equals + 1, word.size())));
  if (name == "heartbeat" && value && *value >= 0 && *value <= longest_heartbeat_ms) {
    drive.heartbeat = std::chrono::milliseconds(*value);
    drive.producer_heartbeat = static_cast<std::uint16_t>(*value);
    return;
  }
  const auto number = name.size() == digits_of_a_number ? whole_number(name) : std::nullopt;
  const KeyaParameterRow* row = number ? find_keya_parameter(static_cast<int>(*number)) : nullptr;
  if (row == nullptr || !value || *value < row->minimum || *value > row->maximum) {
    refuse_spec("drive option", word,
                "use coast, ramp, queries-feed, repeat-ignored, zero-ignored, other-kept, sub-00, keeps-counts, "
                "period-only, heartbeat=MS, or a parameter of the manual and its value, for example 0020=3");
  }
  drive.parameters[row->number] = *value;
}

}  // namespace axisgate::simulated
