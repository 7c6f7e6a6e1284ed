#include "tests/sim/modbus_client.hpp"

#include <array>

namespace axisgate::test {
namespace {

constexpr std::uint16_t kMbapLength = 7;
constexpr std::size_t kMaxUnanswered = 3;

}  // namespace

ModbusClient::ModbusClient(const modbus_tcp::SessionContext& context, Runtime& runtime, std::uint64_t seed,
                           std::uint16_t port, std::vector<ClientAxis> axes, Asked& asked,
                           std::function<void(std::string)> violated)
    : context_(context),
      runtime_(runtime),
      random_(seed),
      axes_(std::move(axes)),
      asked_(asked),
      violated_(std::move(violated)),
      timer_(runtime.make_timer([this] {
        session_->on_deadline(runtime_.now());
        receive();
      })),
      next_action_(runtime.now() + std::chrono::milliseconds(10)) {
  peer_.address[15] = 1;  // ::1
  peer_.port = port;
  peer_.role = Role::engineer;
  connect();
}

ModbusClient::~ModbusClient() { session_->on_closed(runtime_.now()); }

void ModbusClient::connect() {
  session_ = std::make_unique<modbus_tcp::Session>(context_, peer_, runtime_.now(), [this] {
    if (!in_session_) receive();
  });
  expected_.clear();
  incoming_.clear();
  command_id_ = 0;
}

// The cable to the PLC is pulled: what it waits for is nobody's.
void ModbusClient::disconnect() {
  session_->on_closed(runtime_.now());
  connect();
}

void ModbusClient::send(std::vector<Byte> pdu) {
  if (expected_.size() >= kMaxUnanswered) return;
  std::vector<Byte> adu(kMbapLength);
  store_be16(adu, 0, ++transaction_);
  store_be16(adu, 4, static_cast<std::uint16_t>(pdu.size() + 1));
  adu[6] = 1;
  expected_.push_back({transaction_, pdu.front()});
  adu.insert(adu.end(), pdu.begin(), pdu.end());
  ++asked_.requests;
  // In two pieces, cut anywhere.
  const auto cut = static_cast<std::size_t>(random_.below(adu.size()));
  in_session_ = true;
  session_->on_bytes(Bytes(adu).first(cut), runtime_.now());
  session_->on_bytes(Bytes(adu).subspan(cut), runtime_.now());
  in_session_ = false;
  receive();
}

void ModbusClient::receive() {
  while (!session_->output().empty()) {
    const Bytes out = session_->output();
    incoming_.insert(incoming_.end(), out.begin(), out.end());
    session_->take_output(out.size(), runtime_.now());
  }
  while (incoming_.size() >= kMbapLength) {
    const std::size_t size = 6U + load_be16(incoming_, 4);
    if (incoming_.size() < size) break;
    take_reply(Bytes(incoming_).first(size));
    incoming_.erase(incoming_.begin(), incoming_.begin() + static_cast<std::ptrdiff_t>(size));
  }
  if (session_->finished()) {
    violated_(std::string("a connection was closed: ") + session_->why_finished());
    disconnect();
  }
  timer_->expires_at(session_->next_deadline());
}

void ModbusClient::take_reply(Bytes adu) {
  ++asked_.replies;
  for (const Byte b : adu) hash_ = mix(hash_, b);
  hash_ = mix(hash_, static_cast<std::uint64_t>(runtime_.now().time_since_epoch().count()));
  if (expected_.empty() || load_be16(adu, 0) != expected_.front().transaction)
    violated_("a reply out of order, or to nothing that was asked");
  else if ((adu[7] & 0x7F) != expected_.front().function)
    violated_("a reply with another function code");
  if (!expected_.empty()) expected_.pop_front();
}

// --- What it asks
// ------------------------------------------------------------------------------------------------------

void ModbusClient::write(AxisNumber axis, std::uint16_t offset, const std::vector<std::uint16_t>& registers) {
  std::vector<Byte> pdu(6 + 2 * registers.size());
  pdu[0] = 16;
  store_be16(pdu, 1, static_cast<std::uint16_t>(100 * axis + offset));
  store_be16(pdu, 3, static_cast<std::uint16_t>(registers.size()));
  pdu[5] = static_cast<Byte>(2 * registers.size());
  for (std::size_t i = 0; i < registers.size(); ++i) store_be16(pdu, 6 + 2 * i, registers[i]);
  send(std::move(pdu));
}

void ModbusClient::command(AxisNumber axis, std::uint16_t number) {
  if (expected_.size() >= kMaxUnanswered) return;
  if (number == 1) asked_.enables.push_back({runtime_.now(), axis});
  if (number == 6 || number == 7) ++asked_.starts;
  if (number >= 6 && number <= 10) asked_.motions.push_back({runtime_.now(), axis, number});
  // Alone, and with a new id each second time: both edge rules are used.
  const std::uint16_t id = random_.chance(1, 2) ? static_cast<std::uint16_t>(++command_id_ + 1) : std::uint16_t{0};
  if (id == 0) {
    write(axis, 54, {0});
    if (expected_.size() < kMaxUnanswered) write(axis, 54, {number});
  } else {
    write(axis, 54, {number, id});
  }
}

void ModbusClient::ask_something() {
  const ClientAxis& chosen = axes_[static_cast<std::size_t>(random_.below(axes_.size()))];
  const AxisNumber axis = chosen.number;
  const auto target = static_cast<std::uint32_t>(random_.below(200'000));
  const auto halves = [](std::uint32_t v) {
    return std::vector<std::uint16_t>{static_cast<std::uint16_t>(v >> 16), static_cast<std::uint16_t>(v & 0xFFFF)};
  };
  switch (random_.below(16)) {
    case 0:
      return write(axis, 42, halves(target));
    case 1:
      asked_.motions.push_back({runtime_.now(), axis, Asked::kVelocityWritten});
      return write(axis, 44, halves(target));
    case 2:
    case 3:
      return write(axis, 48, halves(asked_.next_unique++ * 1000));
    case 4:
      return command(axis, 1);
    case 5:
      return command(axis, 6);
    case 6:
      return command(axis, 8);
    case 7:
      return command(axis, static_cast<std::uint16_t>(2 + random_.below(3)));
    case 8:
      return command(axis, 5);
    case 9:
      return command(axis, random_.chance(1, 2) ? 7 : 10);
    case 10:
    case 11:
      return ask_rarely(chosen);
    default: {
      std::vector<Byte> pdu(5);
      pdu[0] = random_.chance(1, 2) ? 3 : 4;
      store_be16(pdu, 1, static_cast<std::uint16_t>(100 * axis));
      store_be16(pdu, 3, 39);
      return send(std::move(pdu));
    }
  }
}

void ModbusClient::ask_rarely(const ClientAxis& axis) {
  switch (random_.below(4)) {
    case 0:
    case 1: {
      const auto& methods = axis.homing_methods;
      return write(axis.number, 60, {methods[static_cast<std::size_t>(random_.below(methods.size()))]});
    }
    case 2:
      if (random_.chance(1, 2)) return raw_controlword(axis.number);
      if (axis.wears) {
        // About a million units each way: never in the way of a move, and almost never what the drive holds.
        const auto low = static_cast<std::uint16_t>(random_.below(0x10000));
        return write(axis.number, 72, {0xFFF0, low, 0x000F, low});
      }
      [[fallthrough]];
    default: {
      if (axis.has_name && random_.chance(1, 2)) return read_name(axis.number);
      // The object mailbox: an object of the drive, or one that does not exist.
      const std::uint16_t object = random_.chance(1, 2) ? axis.an_object : std::uint16_t{0x5FFF};
      return write(axis.number, 80, {1, object, 0, 2});
    }
  }
}

// By 43/13: in several exchanges, which whatever is more urgent may break off.
void ModbusClient::read_name(AxisNumber axis) {
  send({0x2B, 0x0D, 0x00, 0x00, static_cast<Byte>(axis), 0x10, 0x08, 0x00, 0x00, 0x00, 0x00, 0x00});
}

// Each word alone, as a servo's programmer writes them. What it may lead to depends on the mode: all of it is asked
// for.
void ModbusClient::raw_controlword(AxisNumber axis) {
  constexpr std::array<std::uint16_t, 7> kWords{0x00, 0x02, 0x06, 0x07, 0x0F, 0x1F, 0x010F};
  const std::uint16_t word = kWords[static_cast<std::size_t>(random_.below(kWords.size()))];
  if (expected_.size() >= kMaxUnanswered) return;
  if ((word & 0xF) == 0xF) {
    asked_.enables.push_back({runtime_.now(), axis});
    for (const std::uint16_t leads_to : {std::uint16_t{6}, std::uint16_t{8}, std::uint16_t{10}})
      asked_.motions.push_back({runtime_.now(), axis, leads_to});
    ++asked_.starts;
  }
  write(axis, 40, {word});
}

void ModbusClient::act() {
  next_action_ = runtime_.now() + std::chrono::milliseconds(1 + random_.below(120));
  if (retired_) {
    if (stopped_ < axes_.size() && expected_.size() < kMaxUnanswered) write(axes_[stopped_++].number, 54, {3});
    return;
  }
  if (random_.chance(1, 200)) disconnect();
  ask_something();
}

void ModbusClient::retire() {
  retired_ = true;
  disconnect();
}

}  // namespace axisgate::test
