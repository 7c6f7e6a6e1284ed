#include "tests/obey/client.hpp"

#include <ostream>
#include <stdexcept>

namespace axisgate::test::obey {
namespace {

using namespace std::chrono_literals;

constexpr std::uint16_t kAxisBase = 100;
constexpr std::size_t kMbap = 7;
constexpr Duration kLongestAnswer = 10s;

void add16(std::vector<std::uint8_t>& out, std::uint32_t value) {
  out.push_back(static_cast<std::uint8_t>(value >> 8));
  out.push_back(static_cast<std::uint8_t>(value));
}

// Modbus application protocol V1.1b3, 6.5, 6.6, 6.11, 6.12, 6.16, 6.17.
std::vector<std::uint8_t> pdu_of(const Write& write) {
  std::vector<std::uint8_t> pdu{static_cast<std::uint8_t>(write.function)};
  const std::uint32_t address = kAxisBase + write.first;
  const auto count = static_cast<std::uint32_t>(write.words.size());
  if (write.function == fc::read_write) {
    add16(pdu, address);
    add16(pdu, 1);
  }
  add16(pdu, address);
  switch (write.function) {
    case fc::write_coil:
      add16(pdu, write.words.at(0) != 0 ? 0xFF00 : 0);
      return pdu;
    case fc::write_register:
      add16(pdu, write.words.at(0));
      return pdu;
    case fc::mask_write:
      add16(pdu, 0);
      add16(pdu, write.words.at(0));
      return pdu;
    case fc::write_coils: {
      add16(pdu, count);
      pdu.push_back(static_cast<std::uint8_t>((count + 7) / 8));
      pdu.resize(pdu.size() + (count + 7) / 8);
      const std::size_t data = pdu.size() - (count + 7) / 8;
      for (std::size_t i = 0; i < count; ++i)
        if (write.words[i] != 0) pdu[data + i / 8] = static_cast<std::uint8_t>(pdu[data + i / 8] | 1U << (i % 8));
      return pdu;
    }
    default:
      add16(pdu, count);
      pdu.push_back(static_cast<std::uint8_t>(2 * count));
      for (const std::uint16_t word : write.words) add16(pdu, word);
      return pdu;
  }
}

}  // namespace

void PrintTo(const Answer& answer, std::ostream* out) {
  if (answer.ok())
    *out << "ok";
  else
    *out << "exception " << int{answer.exception};
}

Client::Client(const modbus_tcp::SessionContext& context, ManualRuntime& runtime, std::uint8_t host)
    : context_(context), runtime_(runtime), timer_(runtime.make_timer([this] {
        in_session_ = true;
        session_->on_deadline(runtime_.now());
        in_session_ = false;
        receive();
      })) {
  peer_.address = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xFF, 0xFF, 192, 168, 1, host};
  peer_.port = 50000;
  peer_.role = Role::engineer;
  connect();
}

Client::~Client() { disconnect(); }

void Client::connect() {
  disconnect();
  ++peer_.port;
  incoming_.clear();
  session_ = std::make_unique<modbus_tcp::Session>(context_, peer_, runtime_.now(), [this] {
    if (!in_session_) receive();
  });
  timer_->expires_at(session_->next_deadline());
}

void Client::disconnect() {
  if (!session_) return;
  session_->on_closed(runtime_.now());
  session_.reset();
  timer_->expires_at(kNever);
}

void Client::receive() {
  while (!session_->output().empty()) {
    const Bytes out = session_->output();
    incoming_.insert(incoming_.end(), out.begin(), out.end());
    session_->take_output(out.size(), runtime_.now());
  }
  timer_->expires_at(session_->next_deadline());
}

Answer Client::ask(const std::vector<std::uint8_t>& pdu) {
  std::vector<std::uint8_t> adu;
  add16(adu, ++transaction_);
  add16(adu, 0);
  add16(adu, static_cast<std::uint32_t>(pdu.size() + 1));
  adu.push_back(1);
  adu.insert(adu.end(), pdu.begin(), pdu.end());
  in_session_ = true;
  session_->on_bytes(Bytes(adu), runtime_.now());
  in_session_ = false;
  receive();
  const Instant end = runtime_.now() + kLongestAnswer;
  while (incoming_.size() < kMbap + 2 || incoming_.size() < 6U + load_be16(incoming_, 4)) {
    if (runtime_.now() >= end) throw std::runtime_error("a request never got its answer");
    runtime_.advance_by(1ms);
  }
  std::vector<std::uint8_t> reply(incoming_.begin() + kMbap, incoming_.begin() + 6 + load_be16(incoming_, 4));
  incoming_.erase(incoming_.begin(), incoming_.begin() + 6 + load_be16(incoming_, 4));
  if (reply[0] == (pdu[0] | 0x80)) return {reply.at(1), {}};
  if (reply[0] != pdu[0]) throw std::runtime_error("an answer with another function code");
  Answer answer;
  if (reply[0] == 3)
    for (std::size_t i = 2; i + 1 < reply.size(); i += 2) answer.words.push_back(load_be16(reply, i));
  return answer;
}

Answer Client::write(const Write& write) { return ask(pdu_of(write)); }

std::vector<std::uint16_t> Client::read(std::uint16_t first, std::uint16_t count) {
  std::vector<std::uint8_t> pdu{3};
  add16(pdu, kAxisBase + first);
  add16(pdu, count);
  Answer answer = ask(pdu);
  if (!answer.ok() || answer.words.size() != count) throw std::runtime_error("a read failed");
  return answer.words;
}

std::int32_t Client::wide(std::uint16_t offset) {
  const auto words = read(offset, 2);
  return static_cast<std::int32_t>(std::uint32_t{words[0]} << 16 | words[1]);
}

bool Client::mailbox_write(std::uint16_t index, std::uint16_t subindex, std::uint16_t size, std::int64_t data) {
  constexpr std::uint16_t kRequest = 80, kLast = 85, kStatus = 86, kBusy = 1, kDone = 2;
  constexpr std::int64_t kWriteObject = 2;
  const Write request =
      block(kRequest, kLast, {{80, kWriteObject}, {81, index}, {82, subindex}, {83, size}, {84, data}});
  if (!write(request).ok()) return false;
  for (int i = 0; i < 1000 && word(kStatus) == kBusy; ++i) runtime_.advance_by(1ms);
  return word(kStatus) == kDone;
}

}  // namespace axisgate::test::obey
