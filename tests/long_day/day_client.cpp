// SPDX-License-Identifier: Apache-2.0
#include "tests/long_day/day_client.hpp"

#include "gateway/core/bytes.hpp"

namespace axisgate::test::long_day {
namespace {

constexpr std::uint8_t kRead = 3, kWrite = 6, kWriteBlock = 16, kException = 0x80;
constexpr std::uint16_t kOfAxis = 100, kShown = 39;  // registers
constexpr std::uint16_t kTargetPosition = 42, kTargetVelocity = 44, kCommand = 54;
constexpr std::size_t kMbap = 7;

void add16(std::vector<Byte>& out, std::uint32_t value) {
  out.push_back(static_cast<Byte>(value >> 8));
  out.push_back(static_cast<Byte>(value));
}

std::vector<Byte> pdu_of(std::uint8_t function, std::uint32_t address, std::uint32_t value) {
  std::vector<Byte> pdu{function};
  add16(pdu, address);
  add16(pdu, value);
  return pdu;
}

std::vector<Byte> wide(std::uint32_t address, std::int32_t value) {
  std::vector<Byte> pdu = pdu_of(kWriteBlock, address, 2);
  pdu.push_back(4);
  add16(pdu, static_cast<std::uint32_t>(value) >> 16);
  add16(pdu, static_cast<std::uint32_t>(value));
  return pdu;
}

}  // namespace

DayClient::DayClient(const modbus_tcp::SessionContext& context, ManualRuntime& runtime, std::uint8_t host,
                     std::vector<AxisNumber> axes, std::uint64_t seed)
    : context_(context), runtime_(runtime), axes_(std::move(axes)), random_(seed), deadline_(runtime.make_timer([this] {
        if (!session_) return;
        session_->on_deadline(runtime_.now());
        receive();
      })) {
  peer_.address = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xFF, 0xFF, 192, 168, 1, host};
  peer_.port = 40'000;
  peer_.role = Role::engineer;
}

void DayClient::connect() {
  ++peer_.port;
  incoming_.clear();
  session_ = std::make_unique<modbus_tcp::Session>(context_, peer_, runtime_.now(), [this] { receive(); });
}

void DayClient::leave() {
  if (!session_) return;
  asked_.lost += waits() ? 1U : 0U;
  session_->on_closed(runtime_.now());
  session_.reset();
  deadline_->expires_at(kNever);
}

void DayClient::turn() {
  receive();
  if (waits()) return;
  if (session_ && session_->finished()) leave();
  if (!session_) connect();
  send(next_pdu());
}

// Speeds where there are, positions where there are: what a drive does not have is refused.
std::vector<Byte> DayClient::next_pdu() {
  constexpr std::int32_t kTurn = 10'000, kRpm = 1'000;
  const std::uint32_t base = kOfAxis * axes_.at(random_.below(axes_.size()));
  const auto some = static_cast<std::int32_t>(random_.below(200)) - 100;
  switch (random_.below(16)) {
    case 0:
      return wide(base + kTargetVelocity, some * kRpm);
    case 1:
      return wide(base + kTargetPosition, some * kTurn);
    case 2:
    case 3:
      return pdu_of(kWrite, base + kCommand, static_cast<std::uint32_t>(Command::enable));
    case 4:
      return pdu_of(kWrite, base + kCommand, static_cast<std::uint32_t>(Command::run_velocity));
    case 5:
      return pdu_of(kWrite, base + kCommand, static_cast<std::uint32_t>(Command::move_absolute));
    case 6:
      return pdu_of(kWrite, base + kCommand, static_cast<std::uint32_t>(Command::halt));
    case 7:
      return pdu_of(kWrite, base + kCommand, static_cast<std::uint32_t>(Command::fault_reset));
    case 8:
      return pdu_of(kWrite, base + kCommand, random_.chance(0.2) ? static_cast<std::uint32_t>(Command::disable) : 0);
    default:
      return pdu_of(kRead, base, kShown);
  }
}

void DayClient::send(const std::vector<Byte>& pdu) {
  std::vector<Byte> adu;
  add16(adu, ++transaction_);
  add16(adu, 0);
  add16(adu, static_cast<std::uint32_t>(pdu.size() + 1));
  adu.push_back(1);
  adu.insert(adu.end(), pdu.begin(), pdu.end());
  ++asked_.requests;
  session_->on_bytes(adu, runtime_.now());
  receive();
}

void DayClient::receive() {
  if (!session_) return;
  while (!session_->output().empty()) {
    const Bytes out = session_->output();
    incoming_.insert(incoming_.end(), out.begin(), out.end());
    session_->take_output(out.size(), runtime_.now());
  }
  deadline_->expires_at(session_->next_deadline());
  while (incoming_.size() > kMbap && incoming_.size() >= 6U + load_be16(incoming_, 4)) {
    if (!waits()) wrong_ = "an answer that nobody asked for";
    if (load_be16(incoming_, 0) != transaction_) wrong_ = "an answer to another request";
    ++asked_.answers;
    asked_.exceptions += (incoming_[kMbap] & kException) != 0 ? 1U : 0U;
    const auto size = static_cast<std::ptrdiff_t>(6 + load_be16(incoming_, 4));
    incoming_.erase(incoming_.begin(), incoming_.begin() + size);
  }
}

}  // namespace axisgate::test::long_day
