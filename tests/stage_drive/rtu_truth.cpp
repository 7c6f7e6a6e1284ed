// SPDX-License-Identifier: Apache-2.0
#include "tests/stage_drive/rtu_truth.hpp"

#include <algorithm>

namespace axisgate::test {
namespace {

namespace fn = simulated::function;

constexpr std::size_t kErrorReply = 5;  // unit, function, code, CRC
constexpr std::size_t kWriteReply = 8;  // unit, function, register, value or count, CRC

// Modbus application protocol V1.1b3, 6.3, 6.6 and 6.12; 32 bits with the low word in the lower register (all three
// sheets).
std::uint32_t raw_at(const std::vector<std::uint16_t>& registers, std::size_t at, std::uint8_t size) {
  const std::uint32_t low = registers[at];
  if (size == 4) return low | std::uint32_t{registers[at + 1]} << 16;
  return size == 1 ? low & 0xFF : low;
}

}  // namespace

RtuRequest request_in(Bytes frame) {
  RtuRequest out{frame[0], frame[1] != fn::read, load_be16(frame, 2), 1, {}};
  if (frame[1] != fn::write_one) out.count = load_be16(frame, 4);
  if (frame[1] == fn::write_one) out.values = {load_be16(frame, 4)};
  if (frame[1] == fn::write_several)
    for (std::size_t i = 0; i < out.count; ++i) out.values.push_back(load_be16(frame, 7 + 2 * i));
  return out;
}

std::optional<std::vector<std::uint16_t>> reply_in(Bytes sent, const RtuRequest& request) {
  const std::size_t size = request.write ? kWriteReply : kErrorReply + 2 * std::size_t{request.count};
  for (std::size_t at = 0; at + size <= sent.size(); ++at) {
    const Bytes window = sent.subspan(at, size);
    if (window[0] != request.unit || !simulated::open_rtu(window)) continue;
    if (request.write) {
      const bool echo = window[1] != fn::read && load_be16(window, 2) == request.start;
      if (echo) return request.values;
      continue;
    }
    if (window[1] != fn::read || window[2] != 2 * request.count) continue;
    std::vector<std::uint16_t> registers;
    for (std::size_t i = 0; i < request.count; ++i) registers.push_back(load_be16(window, 3 + 2 * i));
    return registers;
  }
  return std::nullopt;
}

RtuTruth::RtuTruth(const compose::Gateway& gateway, RtuLinkSim& link, AxisNumber axis)
    : drive_(*gateway.drive_of(axis)), link_(link), axis_(axis), seen_(drive_.model().objects.size()) {}

std::optional<std::string> RtuTruth::lie() {
  std::optional<std::string> found;
  for (std::size_t id = 0; id < seen_.size(); ++id) {
    const drive::ObjectState& state = drive_.store()[static_cast<model::ObjectId>(id)];
    if (!state.known || state.emulated || state.exchange == seen_[id]) continue;
    seen_[id] = state.exchange;
    ++looked_at_;
    const model::ObjectDef& object = drive_.model().object(static_cast<model::ObjectId>(id));
    // What a trigger holds is shown to nobody, and a stop that is sent again may have the acknowledgement of the first.
    if (found || object.trigger || true_of(object, state)) continue;
    found = "axis " + std::to_string(axis_) + " " + object.name + " holds " + std::to_string(state.number) +
            ", which was not sent for it";
  }
  return found;
}

// One exchange at a time is on the line: the first request that the drive heard after it was sent is the one.
const simulated::RtuExchange* RtuTruth::asked_at(Instant sent) const {
  const simulated::RtuExchange* first = nullptr;
  const auto& journal = link_.line().journal().entries();
  for (auto entry = journal.rbegin(); entry != journal.rend() && entry->received >= link_.time_of(sent); ++entry)
    if (entry->station == drive_.model().node) first = &*entry;
  return first;
}

bool RtuTruth::true_of(const model::ObjectDef& object, const drive::ObjectState& state) const {
  const simulated::RtuExchange* exchange = asked_at(state.sent_at);
  if (exchange == nullptr) return false;
  const RtuRequest request = request_in(exchange->request);
  const std::uint16_t number = object.address.index;
  const std::uint16_t last = object.size == 4 ? static_cast<std::uint16_t>(number + 1) : number;
  if (!request.covers(number) || !request.covers(last)) return false;
  const auto registers = reply_in(exchange->sent, request);
  return registers && object.number(raw_at(*registers, number - request.start, object.size)) == state.number;
}

}  // namespace axisgate::test
