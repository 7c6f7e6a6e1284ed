// SPDX-License-Identifier: Apache-2.0
#include "adapters/modbus_rtu/link/port_worker.hpp"

#include <poll.h>
#include <pthread.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <boost/asio/post.hpp>
#include <boost/noncopyable.hpp>
#include <cerrno>
#include <csignal>
#include <mutex>
#include <system_error>
#include <utility>
#include <variant>

#include "adapters/modbus_rtu/rtu_codec.hpp"
#include "gateway/core/rtu_crc.hpp"

namespace axisgate::modbus_rtu {

namespace {

struct Opened {
  std::vector<std::string> notes;
};
struct NotOpened {
  std::string why;
};
struct Lost {
  std::string why;
};
struct HeardFrame {
  ExchangeNumber newest = 0;
  Frame frame;
};
struct Noise {
  ExchangeNumber newest = 0;
  std::size_t bytes = 0;
};
struct Glitch {
  std::size_t bytes = 0;
};
struct Told {
  OpeningNumber opening = 0;
  std::variant<Opened, NotOpened, Lost, HeardFrame, Noise, Glitch> what;
};

struct Outgoing {
  ExchangeNumber number = 0;
  Frame frame;
};
struct Commands {
  bool stop = false;
  bool close = false;
  std::optional<OpeningNumber> open{};
};

}  // namespace

/// What the two threads share; handlers in the core's queue may outlive the worker and keep it.
class PortWorker::Mailbox : public std::enable_shared_from_this<Mailbox>, boost::noncopyable {
 public:
  Mailbox(boost::asio::io_context& context, PortWorkerEvents& events)
      : context_(context), events_(&events), wake_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
    if (wake_ < 0) throw std::system_error(errno, std::generic_category(), "eventfd");
    told_.reserve(kMaxHeard + 4);
  }
  ~Mailbox() { ::close(wake_); }

  // --- The core's side ---
  template <typename Change>
  void command(Change change) {
    {
      const std::lock_guard lock(mutex_);
      change(commands_, outgoing_);
    }
    const std::uint64_t one = 1;
    static_cast<void>(::write(wake_, &one, sizeof one));  // fails only where it is awake already
  }
  /// From now on nobody is called.
  void forget() { events_ = nullptr; }

  // --- The worker's side ---
  [[nodiscard]] int wake_descriptor() const { return wake_; }
  [[nodiscard]] Commands take_commands() {
    std::uint64_t times = 0;
    static_cast<void>(::read(wake_, &times, sizeof times));
    const std::lock_guard lock(mutex_);
    return std::exchange(commands_, {});
  }
  [[nodiscard]] bool has_outgoing() {
    const std::lock_guard lock(mutex_);
    return outgoing_.has_value();
  }
  [[nodiscard]] std::optional<Outgoing> take_outgoing() {
    const std::lock_guard lock(mutex_);
    return std::exchange(outgoing_, std::nullopt);
  }
  /// State is always told, and there is little of it: one opening and one end of it for each that was asked for.
  void tell(Told told) {
    const std::lock_guard lock(mutex_);
    told_.push_back(std::move(told));
    post();
  }
  void tell_heard(Told told, std::size_t bytes) {
    const std::lock_guard lock(mutex_);
    if (heard_ == kMaxHeard) {
      overflow_.opening = told.opening;
      overflow_bytes_ += bytes;
      return;  // a delivery is posted
    }
    ++heard_;
    told_.push_back(std::move(told));
    post();
  }

 private:
  void post() {
    if (std::exchange(posted_, true)) return;
    boost::asio::post(context_, [self = shared_from_this()] { self->deliver(); });
  }
  [[nodiscard]] std::vector<Told> take_told() {
    std::vector<Told> fresh;
    fresh.reserve(kMaxHeard + 4);
    const std::lock_guard lock(mutex_);
    posted_ = false;
    heard_ = 0;
    if (const std::size_t dropped = std::exchange(overflow_bytes_, 0); dropped > 0) {
      overflow_.what = Noise{0, dropped};
      told_.push_back(overflow_);
    }
    std::swap(fresh, told_);
    return fresh;
  }
  /// On the core's thread. An event may destroy the worker: then the rest is nobody's.
  void deliver() {
    for (const Told& told : take_told()) {
      if (events_ == nullptr) return;
      std::visit([&](const auto& what) { hand_over(told.opening, what); }, told.what);
    }
  }
  void hand_over(OpeningNumber opening, const Opened& it) { events_->on_opened(opening, it.notes); }
  void hand_over(OpeningNumber opening, const NotOpened& it) { events_->on_not_opened(opening, it.why); }
  void hand_over(OpeningNumber opening, const Lost& it) { events_->on_lost(opening, it.why); }
  void hand_over(OpeningNumber opening, const HeardFrame& it) { events_->on_heard(opening, it.newest, it.frame); }
  void hand_over(OpeningNumber opening, const Noise& it) { events_->on_noise(opening, it.newest, it.bytes); }
  void hand_over(OpeningNumber opening, const Glitch& it) { events_->on_glitch(opening, it.bytes); }

  boost::asio::io_context& context_;
  PortWorkerEvents* events_;  // of the core's thread alone
  int wake_;
  std::mutex mutex_;
  Commands commands_;
  std::optional<Outgoing> outgoing_;  // stays until it leaves: up to then it may be withdrawn
  std::vector<Told> told_;
  std::size_t heard_ = 0;
  Told overflow_;
  std::size_t overflow_bytes_ = 0;
  bool posted_ = false;
};

/// The worker's own thread.
class PortWorker::Loop {
 public:
  Loop(std::shared_ptr<Mailbox> mailbox, serial::SerialSettings settings, Duration adapter_latency)
      : mailbox_(std::move(mailbox)), port_(std::move(settings), adapter_latency) {}

  void run() {
    while (true) {
      const short ready = wait();
      const Commands todo = mailbox_->take_commands();
      if (todo.stop) return;
      if (todo.close) port_.close();
      if (todo.open) open(*todo.open);
      to_send_ = port_.is_open() && mailbox_->has_outgoing();
      if (to_send_) {
        listen_or_send();
      } else if ((ready != 0 || port_.unfinished()) && port_.is_open() && !todo.open) {
        listen(ready);
      }
    }
  }

 private:
  /// Until something is to be done. What the port has; 0 where it has nothing.
  [[nodiscard]] short wait() {
    std::array<pollfd, 2> waited{{{mailbox_->wake_descriptor(), POLLIN, 0}, {port_.descriptor(), POLLIN, 0}}};
    std::optional<Duration> longest;
    if (port_.unfinished()) {
      longest = port_.patience_left();
    } else if (to_send_) {
      longest = Duration{};
    } else if (noisy_) {
      longest = gap_time(port_.settings().baud);
    }
    constexpr std::int64_t kSecond = 1'000'000'000;
    const std::int64_t ns = longest.value_or(Duration{}).count();
    const timespec time{static_cast<time_t>(ns / kSecond), static_cast<long>(ns % kSecond)};
    const int ready = ::ppoll(waited.data(), waited.size(), longest ? &time : nullptr, nullptr);
    if (ready == 0 && !to_send_) noisy_ = false;
    return ready > 0 ? waited[1].revents : short{0};
  }

  void open(OpeningNumber opening) {
    port_.close();
    noisy_ = false;
    opening_ = opening;
    LibmodbusPort::Opening opened = port_.open();
    if (port_.is_open()) {
      mailbox_->tell({opening_, Opened{std::move(opened.notes)}});
    } else {
      mailbox_->tell({opening_, NotOpened{std::move(opened.error)}});
    }
  }

  /// What has come by now was heard before the frame is sent, and must be told so.
  void listen_or_send() {
    if (reads_before_sending_ < kMaxReadsBeforeSending && (port_.bytes_waiting() > 0 || port_.unfinished())) {
      ++reads_before_sending_;
      listen(POLLIN);
      return;
    }
    reads_before_sending_ = 0;
    to_send_ = false;
    const std::optional<Outgoing> outgoing = mailbox_->take_outgoing();
    if (!outgoing) return;
    if (const std::size_t half = port_.drop(); half > 0) tell_noise(half);
    noisy_ = false;
    newest_ = outgoing->number;
    if (std::string why = port_.transmit(outgoing->frame); !why.empty()) lose(std::move(why));
  }

  void listen(short ready) {
    Heard heard = noisy_ ? port_.skip() : port_.receive(true);
    // A port that reports an error for ever and has no bytes must not keep us busy for ever.
    if (heard.kind == Heard::Kind::nothing && (ready & (POLLERR | POLLHUP | POLLNVAL)) != 0) {
      lose(port_.settings().device + ": hung up");
      return;
    }
    while (tell(heard)) heard = port_.receive(false);
  }

  /// True: more may have been read with it.
  bool tell(const Heard& heard) {
    switch (heard.kind) {
      case Heard::Kind::frame:
        mailbox_->tell_heard({opening_, HeardFrame{newest_, Frame(heard.frame.begin(), heard.frame.end())}},
                             heard.frame.size() + kCrcSize);
        return true;
      case Heard::Kind::glitch:
        mailbox_->tell_heard({opening_, Glitch{heard.bytes}}, heard.bytes);
        return true;
      case Heard::Kind::noise:
        noisy_ = true;
        tell_noise(heard.bytes);
        return false;
      case Heard::Kind::lost:
        lose(heard.why);
        return false;
      case Heard::Kind::nothing:
        return false;
    }
    return false;
  }

  void tell_noise(std::size_t bytes) { mailbox_->tell_heard({opening_, Noise{newest_, bytes}}, bytes); }

  void lose(std::string why) {
    port_.close();
    mailbox_->tell({opening_, Lost{std::move(why)}});
  }

  std::shared_ptr<Mailbox> mailbox_;
  LibmodbusPort port_;
  OpeningNumber opening_ = 0;
  ExchangeNumber newest_ = 0;
  bool noisy_ = false;    ///< after what was no frame, until the line is silent
  bool to_send_ = false;  ///< a frame waits to leave
  int reads_before_sending_ = 0;
};

PortWorker::PortWorker(serial::SerialSettings settings, Duration adapter_latency, boost::asio::io_context& context,
                       PortWorkerEvents& events)
    : mailbox_(std::make_shared<Mailbox>(context, events)) {
  // Signals are the core's affair.
  sigset_t all{};
  sigset_t before{};
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  thread_ =
      std::thread([loop = std::make_unique<Loop>(mailbox_, std::move(settings), adapter_latency)] { loop->run(); });
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

PortWorker::~PortWorker() {
  mailbox_->forget();
  mailbox_->command([](Commands& commands, auto&) { commands.stop = true; });
  thread_.join();
}

void PortWorker::open(OpeningNumber opening) {
  mailbox_->command([&](Commands& commands, std::optional<Outgoing>& outgoing) {
    commands.open = opening;
    outgoing.reset();
  });
}

void PortWorker::close() {
  mailbox_->command([](Commands& commands, std::optional<Outgoing>& outgoing) {
    commands = {.stop = commands.stop, .close = true};
    outgoing.reset();
  });
}

bool PortWorker::send(ExchangeNumber number, Bytes frame) {
  bool line_was_free = true;
  mailbox_->command([&](Commands&, std::optional<Outgoing>& outgoing) {
    line_was_free = !outgoing;
    outgoing = {number, Frame(frame.begin(), frame.end())};
  });
  return line_was_free;
}

void PortWorker::withdraw(ExchangeNumber number) {
  mailbox_->command([&](Commands&, std::optional<Outgoing>& outgoing) {
    if (outgoing && outgoing->number == number) outgoing.reset();
  });
}

}  // namespace axisgate::modbus_rtu
