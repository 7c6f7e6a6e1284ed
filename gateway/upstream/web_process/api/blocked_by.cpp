// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/web_process/api/blocked_by.hpp"

#include "gateway/core/words.hpp"
#include "gateway/image/command.hpp"
#include "gateway/image/process_image.hpp"
#include "gateway/upstream/web_process/api/fault_json.hpp"

namespace axisgate::web {
namespace {

class Blocks {
 public:
  explicit Blocks(const AxisPicture& axis) : axis_(axis) {}

  void add(WordKind kind, std::uint32_t number, std::string text = {}, std::string remedy = {}) {
    const Word* word = find_word(kind, number);
    if (word == nullptr) return;
    out_.push_back({std::string(word->name), text.empty() ? std::string(word->meaning) : std::move(text),
                    remedy.empty() ? remedy_for(*word, axis_.info.axis) : std::move(remedy)});
  }
  void add(AxisAlarm alarm) { add(WordKind::axis_alarm, static_cast<std::uint32_t>(alarm)); }
  [[nodiscard]] std::vector<Block> take() { return std::move(out_); }

 private:
  const AxisPicture& axis_;
  std::vector<Block> out_;
};

bool moves(const AxisPicture& axis) {
  const auto state = static_cast<AxisState>(axis.sample.axis_state);
  return state == AxisState::discrete_motion || state == AxisState::continuous_motion || state == AxisState::homing;
}

/// It is in a mode that counts from the reference: interpolated and cyclic synchronous position too.
bool positions(const AxisPicture& axis) {
  constexpr std::int64_t kProfilePosition = 1, kInterpolated = 7, kCyclicPosition = 8;
  const std::int64_t mode = axis.of(Quantity::mode_display).value;
  return mode == kProfilePosition || mode == kInterpolated || mode == kCyclicPosition;
}

/// Alarms that an enable or a start is refused for; a latched stop comes behind them.
void add_alarms(const AxisPicture& axis, Blocks& out) {
  for (const Word& word : words())
    if (word.kind == WordKind::axis_alarm && (axis.sample.alarms >> word.number & 1U) != 0 &&
        (word.refuses_enable || word.number == static_cast<std::uint32_t>(AxisAlarm::units_disagree)))
      out.add(WordKind::axis_alarm, word.number);
}

}  // namespace

std::vector<Block> blocked_by(const Picture& picture, const AxisPicture& axis, SteadyNs now) {
  Blocks out(axis);
  if (!picture.joined(now) || axis.sampled == 0) {
    out.add(WordKind::axis_state, static_cast<std::uint32_t>(AxisState::unknown), "nothing is heard of the gateway",
            "see whether it runs and what its log says; never take the axis for disabled");
    return out.take();
  }
  const auto link = static_cast<LinkState>(axis.sample.link_state);
  if (link != LinkState::online && link != LinkState::suspect) {
    out.add(WordKind::link_state, axis.sample.link_state, {},
            link == LinkState::setup || link == LinkState::unknown ? "wait until it is online" : "");
    return out.take();
  }
  if (picture.statistics().state == static_cast<std::uint8_t>(GatewayState::stopping))
    out.add(WordKind::gateway_state, static_cast<std::uint32_t>(GatewayState::stopping), {}, "start it again");
  if (axis.fault != 0) {
    const FaultText fault = fault_text(picture, axis);
    out.add(WordKind::axis_state, static_cast<std::uint32_t>(AxisState::error_stop), fault.text, fault.remedy);
  }
  add_alarms(axis, out);
  const bool latched = axis.has(AxisAlarm::stop_latched);
  if (latched) out.add(AxisAlarm::stop_latched);
  if (moves(axis)) return out.take();
  if (!axis.sample.owner.empty())
    out.add(WordKind::result, static_cast<std::uint32_t>(CommandResult::not_owner),
            axis.sample.owner + " owns the axis: others than it are refused");
  if (axis.has(AxisAlarm::not_homed) && positions(axis)) out.add(AxisAlarm::not_homed);
  if (!latched && axis.sample.axis_state == static_cast<std::uint8_t>(AxisState::disabled))
    out.add(WordKind::axis_state, static_cast<std::uint32_t>(AxisState::disabled), {},
            "enable: command 1, or coil 0 from 0 to 1");
  return out.take();
}

}  // namespace axisgate::web
