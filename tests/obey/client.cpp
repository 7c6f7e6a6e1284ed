// SPDX-License-Identifier: Apache-2.0
#include "tests/obey/client.hpp"

#include <deque>
#include <functional>
#include <ostream>
#include <stdexcept>

namespace axisgate::test::obey {
namespace {

using namespace std::chrono_literals;

constexpr std::uint16_t kAxisBase = 100;
constexpr std::uint8_t kUnit = 1;  // with "unit_ids": "per-axis" the axis; else any
constexpr std::size_t kMbap = 7;
constexpr Duration kLongestAnswer = 10s;

void add16(std::vector<std::uint8_t>& out, std::uint32_t value) {
  out.push_back(static_cast<std::uint8_t>(value >> 8));
  out.push_back(static_cast<std::uint8_t>(value));
}

constexpr std::uint8_t kReference = fc::general_reference, kCanopen = 0x0D;  // 43/13
constexpr std::size_t kReferenceHead = 12;

// V1.1b3 annex B: one object of axis 1 from its first byte on; count 0: all that a read finds.
std::vector<std::uint8_t> reference_of(bool write, std::uint16_t index, std::uint16_t sub, std::uint16_t count) {
  std::vector<std::uint8_t> pdu{kReference, kCanopen, static_cast<std::uint8_t>(write ? 1 : 0), 0, 1};
  add16(pdu, index);
  pdu.push_back(static_cast<std::uint8_t>(sub));
  add16(pdu, 0);
  add16(pdu, count);
  return pdu;
}

// Modbus application protocol V1.1b3, 6.5, 6.6, 6.11, 6.12, 6.16, 6.17, 6.20.
std::vector<std::uint8_t> pdu_of(const Write& write, std::uint16_t base) {
  if (write.function == fc::general_reference) {
    const std::vector<std::uint16_t>& mailbox = write.words;
    std::vector<std::uint8_t> pdu = reference_of(true, mailbox.at(1), mailbox.at(2), mailbox.at(3));
    const std::uint32_t data = std::uint32_t{mailbox.at(4)} << 16 | mailbox.at(5);
    for (unsigned i = 0; i < mailbox.at(3); ++i) pdu.push_back(static_cast<std::uint8_t>(data >> (8 * i)));
    return pdu;
  }
  std::vector<std::uint8_t> pdu{static_cast<std::uint8_t>(write.function)};
  const std::uint32_t address = std::uint32_t{base} + write.first;
  const auto count = static_cast<std::uint32_t>(write.words.size());
  if (write.function == fc::read_write) {
    add16(pdu, base);
    add16(pdu, shown::count);
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

/// "word_order": "low-first": the halves of each whole row of 32 bits the other way round.
Write low_word_first(Write write) {
  if (write.coils() || write.function == fc::general_reference) return write;
  for (std::size_t i = 0; i + 1 < write.words.size(); ++i)
    if (is_wide(static_cast<std::uint16_t>(write.first + i))) std::swap(write.words[i], write.words[i + 1]), ++i;
  return write;
}

}  // namespace

void PrintTo(const Answer& answer, std::ostream* out) {
  if (answer.ok())
    *out << "ok";
  else
    *out << "exception " << int{answer.exception};
}

/// One connection: what the client sent and the session has not read yet, and the answers that are not told yet.
class Client::Connection {
 public:
  using OnAnswer = std::function<void(RequestNumber, Answer)>;
  Connection(const ServedPort& port, const modbus_tcp::SessionContext& context, ManualRuntime& runtime,
             const modbus_tcp::Peer& peer, OnAnswer on_answer);

  void send(RequestNumber number, const std::vector<std::uint8_t>& pdu);
  void say(const std::vector<std::uint8_t>& bytes) {
    any_bytes_ = true;
    unread_.push_back(bytes);
    turn();
  }
  [[nodiscard]] std::size_t replies() const { return replies_; }
  void close();
  /// What comes is read by nobody.
  void silence() {
    on_answer_ = [](RequestNumber, const Answer&) {};
  }
  [[nodiscard]] bool open() const { return session_ != nullptr; }

 private:
  struct Asked {
    RequestNumber number;
    std::uint8_t function;
  };
  void turn();
  void receive();
  void take_answer(const std::vector<std::uint8_t>& adu);

  const ServedPort& port_;
  ManualRuntime& runtime_;
  OnAnswer on_answer_;
  std::unique_ptr<Timer> deadline_;
  std::unique_ptr<Timer> turn_;
  std::deque<std::vector<std::uint8_t>> unread_;
  std::vector<std::uint8_t> incoming_;
  std::map<std::uint16_t, Asked> asked_;  ///< by transaction
  std::uint16_t transaction_ = 0;
  bool in_session_ = false;
  bool any_bytes_ = false;  ///< were said: no answer is looked into
  std::size_t replies_ = 0;
  std::unique_ptr<modbus_tcp::Session> session_;
};

Client::Connection::Connection(const ServedPort& port, const modbus_tcp::SessionContext& context,
                               ManualRuntime& runtime, const modbus_tcp::Peer& peer, OnAnswer on_answer)
    : port_(port),
      runtime_(runtime),
      on_answer_(std::move(on_answer)),
      deadline_(runtime.make_timer([this] {
        in_session_ = true;
        session_->on_deadline(runtime_.now());
        in_session_ = false;
        turn();
      })),
      turn_(runtime.make_timer([this] { turn(); })),
      session_(std::make_unique<modbus_tcp::Session>(context, peer, runtime.now(), [this] {
        if (!in_session_) receive();
      })) {
  deadline_->expires_at(session_->next_deadline());
}

void Client::Connection::close() {
  if (!session_) return;
  session_->on_closed(runtime_.now());
  session_.reset();
  deadline_->expires_at(kNever);
  turn_->expires_at(kNever);
}

void Client::Connection::send(RequestNumber number, const std::vector<std::uint8_t>& pdu) {
  std::vector<std::uint8_t> adu;
  add16(adu, ++transaction_);
  add16(adu, 0);
  add16(adu, static_cast<std::uint32_t>(pdu.size() + 1));
  adu.push_back(kUnit);
  adu.insert(adu.end(), pdu.begin(), pdu.end());
  asked_[transaction_] = {number, pdu[0]};
  port_.on_modbus(true, adu);
  unread_.push_back(std::move(adu));
  turn();
}

/// As the server does: reads while the session wants more, and closes what is finished.
void Client::Connection::turn() {
  receive();
  while (!unread_.empty() && session_->wants_input()) {
    in_session_ = true;
    session_->on_bytes(Bytes(unread_.front()), runtime_.now());
    in_session_ = false;
    unread_.pop_front();
    receive();
  }
  if (session_->finished()) close();
}

void Client::Connection::receive() {
  while (!session_->output().empty()) {
    const Bytes out = session_->output();
    incoming_.insert(incoming_.end(), out.begin(), out.end());
    session_->take_output(out.size(), runtime_.now());
  }
  deadline_->expires_at(session_->next_deadline());
  // Where the session reads no more for now, an answer of its own leads here again.
  if ((!unread_.empty() && session_->wants_input()) || session_->finished()) turn_->expires_at(runtime_.now());
  while (incoming_.size() >= kMbap + 2 && incoming_.size() >= 6U + load_be16(incoming_, 4)) {
    const auto end = incoming_.begin() + 6 + load_be16(incoming_, 4);
    const std::vector<std::uint8_t> adu(incoming_.begin(), end);
    incoming_.erase(incoming_.begin(), end);
    ++replies_;
    if (any_bytes_) continue;
    port_.on_modbus(false, adu);
    take_answer(adu);
  }
}

void Client::Connection::take_answer(const std::vector<std::uint8_t>& adu) {
  const auto found = asked_.find(load_be16(adu, 0));
  if (found == asked_.end()) throw std::runtime_error("an answer that nobody asked for");
  const Asked asked = found->second;
  asked_.erase(found);
  Answer answer;
  if (adu[kMbap] == (asked.function | 0x80))
    answer.exception = adu.at(kMbap + 1);
  else if (adu[kMbap] != asked.function)
    throw std::runtime_error("an answer with another function code");
  else if (asked.function == 3 || asked.function == fc::read_write)
    for (std::size_t i = kMbap + 2; i + 1 < adu.size(); i += 2) answer.words.push_back(load_be16(adu, i));
  else if (asked.function == kReference)
    answer.words.assign(adu.begin() + kMbap + kReferenceHead, adu.end());
  on_answer_(asked.number, std::move(answer));
}

void ServedPort::close() {
  for (Client* client : clients_) client->lose_connections();
  context_.reset();
}

Client::Client(ServedPort& port, ManualRuntime& runtime, std::uint8_t host,
               std::optional<modbus_tcp::ListenerSettings> listener)
    : port_(port), runtime_(runtime), listener_(std::move(listener)) {
  peer_.address = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xFF, 0xFF, 192, 168, 1, host};
  peer_.port = 50000;
  peer_.role = Role::engineer;
  port_.clients_.push_back(this);
  connect();
}

Client::~Client() {
  disconnect();
  give_up_vanished();
  std::erase(port_.clients_, this);
}

const modbus_tcp::ListenerSettings& Client::settings() const {
  static const modbus_tcp::ListenerSettings kNone;
  return listener_ ? *listener_ : port_.context_ ? port_.context_->settings : kNone;
}

std::uint16_t Client::base() const { return settings().per_axis_units ? 0 : kAxisBase; }

void Client::connect() {
  disconnect();
  ++peer_.port;
  if (!port_.context_) return;
  const modbus_tcp::SessionContext& of = *port_.context_;
  const modbus_tcp::SessionContext own{
      listener_ ? *listener_ : of.settings, of.image, of.commands, of.clients, of.log, of.runtime};
  connection_ = std::make_unique<Connection>(port_, own, runtime_, peer_, [this](RequestNumber number, Answer answer) {
    answers_[number] = std::move(answer);
  });
}

RequestNumber Client::ask_for_object(std::uint16_t index, std::uint8_t subindex) {
  return begin(reference_of(false, index, subindex, 0));
}

void Client::disconnect() {
  if (connection_) connection_->close();
  connection_.reset();
}

bool Client::connected() const { return connection_ && connection_->open(); }

void Client::vanish() {
  if (!connected()) return;
  connection_->silence();
  vanished_.push_back(std::move(connection_));
}

void Client::give_up_vanished() {
  for (const auto& connection : vanished_) connection->close();
  vanished_.clear();
}

void Client::lose_connections() {
  connection_.reset();
  vanished_.clear();
}

RequestNumber Client::begin(const std::vector<std::uint8_t>& pdu) {
  ++last_;
  if (connected()) connection_->send(last_, pdu);
  return last_;
}

void Client::say(const std::vector<std::uint8_t>& bytes) {
  if (connected()) connection_->say(bytes);
}

std::size_t Client::replies() const { return connection_ ? connection_->replies() : 0; }

RequestNumber Client::begin(const Write& write) {
  return begin(pdu_of(settings().low_word_first ? low_word_first(write) : write, base()));
}

std::optional<Answer> Client::answer_of(RequestNumber number) const {
  const auto found = answers_.find(number);
  if (found == answers_.end()) return {};
  return found->second;
}

Answer Client::awaited(RequestNumber number) {
  const Instant end = runtime_.now() + kLongestAnswer;
  while (!answers_.contains(number)) {
    if (!connected()) throw std::runtime_error("a request without a connection");
    if (runtime_.now() >= end) throw std::runtime_error("a request never got its answer");
    runtime_.advance_by(1ms);
  }
  return std::move(answers_.extract(number).mapped());
}

Answer Client::write(const Write& write) { return awaited(begin(write)); }

RequestNumber Client::begin_read(std::uint16_t first, std::uint16_t count) {
  std::vector<std::uint8_t> pdu{3};
  add16(pdu, std::uint32_t{base()} + first);
  add16(pdu, count);
  return begin(pdu);
}

std::vector<std::uint16_t> Client::read(std::uint16_t first, std::uint16_t count) {
  Answer answer = answer_to_read(first, count);
  if (!answer.ok() || answer.words.size() != count) throw std::runtime_error("a read failed");
  return answer.words;
}

std::int32_t Client::wide(std::uint16_t offset) {
  const auto words = read(offset, 2);
  const bool low_first = settings().low_word_first;
  return static_cast<std::int32_t>(std::uint32_t{words[low_first ? 1 : 0]} << 16 | words[low_first ? 0 : 1]);
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
