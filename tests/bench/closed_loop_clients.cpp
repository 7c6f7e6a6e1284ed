#include "tests/bench/closed_loop_clients.hpp"

#include <arpa/inet.h>
#include <netinet/tcp.h>
#include <sys/epoll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace axisgate::bench {
namespace {

[[noreturn]] void fail(const char* what) { throw std::system_error(errno, std::generic_category(), what); }

class Client {
 public:
  explicit Client(std::uint16_t port) : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    const int on = 1;
    ::setsockopt(socket_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(port);
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (::connect(socket_, reinterpret_cast<const sockaddr*>(&to), sizeof to) != 0) fail("connect");
  }
  ~Client() {
    if (socket_ >= 0) ::close(socket_);
  }
  Client(Client&& other) noexcept : socket_(std::exchange(other.socket_, -1)), received_(other.received_) {}
  Client(const Client&) = delete;
  Client& operator=(const Client&) = delete;
  Client& operator=(Client&&) = delete;

  [[nodiscard]] int socket() const { return socket_; }
  void ask(Bytes request) const {
    if (::send(socket_, request.data(), request.size(), MSG_NOSIGNAL) != static_cast<ssize_t>(request.size()))
      fail("send");
  }
  /// True: the reply is whole.
  bool take(std::size_t reply_size) {
    std::array<Byte, 512> part;
    const ssize_t got = ::recv(socket_, part.data(), part.size(), MSG_DONTWAIT);
    if (got == 0) throw std::runtime_error("the server closed a connection");
    if (got < 0) fail("recv");
    received_ += static_cast<std::size_t>(got);
    if (received_ > reply_size) throw std::runtime_error("the server's reply is too long");
    if (received_ < reply_size) return false;
    received_ = 0;
    return true;
  }

 private:
  int socket_;
  std::size_t received_ = 0;
};

class EpollSet {
 public:
  EpollSet() : descriptor_(::epoll_create1(EPOLL_CLOEXEC)) {}
  ~EpollSet() { ::close(descriptor_); }
  EpollSet(const EpollSet&) = delete;
  EpollSet& operator=(const EpollSet&) = delete;
  void add(int socket, std::uint32_t index) const {
    epoll_event event{};
    event.events = EPOLLIN;
    event.data.u32 = index;
    if (::epoll_ctl(descriptor_, EPOLL_CTL_ADD, socket, &event) != 0) fail("epoll_ctl");
  }
  [[nodiscard]] int wait(std::array<epoll_event, 128>& events) const {
    const int ready = ::epoll_wait(descriptor_, events.data(), static_cast<int>(events.size()), 2000);
    if (ready == 0) throw std::runtime_error("no reply for 2 s");
    return ready;
  }

 private:
  int descriptor_;
};

}  // namespace

double replies_per_second(const Load& load) {
  using Clock = std::chrono::steady_clock;
  std::vector<Client> clients;
  const EpollSet ready_set;
  for (int i = 0; i < load.clients; ++i) {
    clients.emplace_back(load.port);
    ready_set.add(clients.back().socket(), static_cast<std::uint32_t>(i));
  }
  for (const Client& client : clients) client.ask(load.request);

  const auto counted_from = Clock::now() + load.lasting / 10;
  const auto end = counted_from + load.lasting;
  std::uint64_t replies = 0;
  std::array<epoll_event, 128> events;
  for (;;) {
    const int ready = ready_set.wait(events);
    const auto now = Clock::now();
    if (now >= end) break;
    for (int i = 0; i < ready; ++i) {
      Client& client = clients[events[static_cast<std::size_t>(i)].data.u32];
      if (!client.take(load.reply_size)) continue;
      if (now >= counted_from) ++replies;
      client.ask(load.request);
    }
  }
  return static_cast<double>(replies) / std::chrono::duration<double>(load.lasting).count();
}

}  // namespace axisgate::bench
