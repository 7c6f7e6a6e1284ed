// SPDX-License-Identifier: Apache-2.0
#include "tests/simulated/kinco_rtu.hpp"

namespace axisgate::simulated {
namespace {

DriveOptions on_modbus(DriveOptions drive, const KincoRtuOptions& rtu) {
  drive.rs485_modbus = true;
  if (rtu.refuses_out_of_range) drive.out_of_range = OutOfRange::refuse;
  return drive;
}

RtuException exception_of(Refusal refusal) {
  switch (refusal) {
    case Refusal::none:
      return RtuException::none;
    case Refusal::no_such_object:
    case Refusal::read_only:
      return RtuException::address;
    case Refusal::wrong_width:
    case Refusal::value_range:
      return RtuException::value;
    case Refusal::device_state:
    case Refusal::local_control:
      return RtuException::device;
  }
  return RtuException::device;
}

}  // namespace

KincoRtu::KincoRtu(const KincoRtuDrive& options)
    : options_(options.rtu),
      drive_(on_modbus(options.drive, options.rtu)),
      registers_(kinco_registers(drive_.model())) {}

std::string KincoRtu::describe() const {
  return std::string(drive_.model().name) + '@' + std::to_string(drive_.options().station);
}

RtuBytes KincoRtu::refusal(RtuView pdu, RtuException code) const {
  const std::uint8_t asked = pdu[0];
  const auto marked = static_cast<std::uint8_t>(asked | 0x80U);
  return exception_pdu(asked == function::read ? options_.read_error_function : marked, code);
}

const ObjectEntry* KincoRtu::entry_at(std::uint16_t number) const {
  const auto found = registers_.find(number);
  if (found == registers_.end() || (found->second.derived && !options_.serves_derived)) return nullptr;
  return drive_.entry(found->second.object);
}

RtuBytes KincoRtu::answer(RtuView pdu, std::uint64_t tag, Time now) {
  const std::uint8_t asked = pdu[0];
  if (asked != function::read && asked != function::write_one && asked != function::write_several) {
    return refusal(pdu, RtuException::function);
  }
  const auto request = register_request(pdu);
  if (!request) return refusal(pdu, RtuException::value);
  if (asked == function::read) return read(*request, now);
  const RtuException refused = write(*request, tag, now);
  return refused == RtuException::none ? write_reply(*request) : refusal(pdu, refused);
}

RtuBytes KincoRtu::read(const RegisterRequest& request, Time now) {
  const RtuBytes pdu = read_pdu(request.start, request.count);
  const ObjectEntry* entry = entry_at(request.start);
  if (entry == nullptr) return refusal(pdu, RtuException::address);
  const bool two = bytes_of(entry->type) == 4;
  // One register of a 32-bit object and reads over several objects are not described; two of a 16-bit one are printed.
  if (request.count < (two ? 2 : 1) || request.count > 2) return refusal(pdu, RtuException::value);
  const std::int64_t value = drive_.read(entry->key(), now).value_or(0);
  std::vector<std::uint16_t> words{static_cast<std::uint16_t>(value)};
  if (bytes_of(entry->type) == 1 && !options_.sign_extends_bytes) words[0] &= 0xFF;
  if (two) words.push_back(static_cast<std::uint16_t>(value >> 16));
  if (!two && request.count == 2) words.push_back(options_.second_register);
  return read_reply(words);
}

RtuException KincoRtu::write(const RegisterRequest& request, std::uint64_t tag, Time now) {
  const ObjectEntry* entry = entry_at(request.start);
  if (entry == nullptr) return RtuException::address;
  const int width = bytes_of(entry->type);
  if (request.count != (width == 4 ? 2 : 1)) return RtuException::value;
  std::uint32_t raw = request.values[0];
  if (width == 4) raw |= static_cast<std::uint32_t>(request.values[1]) << 16;
  // 8-bit objects take the low byte, whatever a negative one has above it (JD 2.2, MD 3.2).
  return exception_of(drive_.write(entry->key(), width, raw, tag, now));
}

}  // namespace axisgate::simulated
