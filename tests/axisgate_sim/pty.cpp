// SPDX-License-Identifier: Apache-2.0
#include "tests/axisgate_sim/pty.hpp"

#include <fcntl.h>
#include <sys/inotify.h>
#include <sys/ioctl.h>
#include <termios.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <stdexcept>

namespace axisgate::simulated {
namespace {

constexpr const char* kSystems = "/dev/pts/";

[[noreturn]] void fail(const std::string& what) { throw std::runtime_error(what + ": " + std::strerror(errno)); }

void make_link(const std::string& link, const std::string& slave, const std::string& terminals) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::file_status there = fs::symlink_status(link, error);
  if (fs::is_symlink(there)) {
    // One that an earlier simulator left behind; any other link is the user's own.
    const std::string to = fs::read_symlink(link, error).string();
    if (!to.starts_with(kSystems) && !to.starts_with(terminals + "/")) {
      throw std::runtime_error(link + " is a link to something else: remove it or choose another path");
    }
    fs::remove(link, error);
  } else if (fs::exists(there)) {
    throw std::runtime_error(link + " exists and is no link: remove it or choose another path");
  }
  fs::create_symlink(slave, link, error);
  if (error) throw std::runtime_error("cannot make the link " + link + " (does its folder exist?): " + error.message());
}

Descriptor open_master(const std::string& terminals) {
  constexpr int kHow = O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC;
  if (terminals.empty()) {
    Descriptor master(::posix_openpt(kHow));
    if (master.get() < 0) fail("cannot open a pseudo-terminal");
    return master;
  }
  const std::string path = terminals + "/ptmx";
  Descriptor master(::open(path.c_str(), kHow));
  if (master.get() < 0)
    fail("cannot open " + path + " (is a devpts mounted there, with ptmxmode=0666: mount -t devpts ...?)");
  return master;
}

}  // namespace

Pty::Pty(const std::string& link, const std::string& terminals) : link_(link), master_(open_master(terminals)) {
  if (::grantpt(master_.get()) != 0 || ::unlockpt(master_.get()) != 0) fail("cannot unlock the pseudo-terminal");
  unsigned number = 0;
  if (::ioctl(master_.get(), TIOCGPTN, &number) != 0) fail("cannot name the pseudo-terminal");
  slave_name_ = (terminals.empty() ? kSystems : terminals + "/") + std::to_string(number);
  slave_ = Descriptor(::open(slave_name_.c_str(), O_RDWR | O_NOCTTY | O_CLOEXEC));
  if (slave_.get() < 0) fail("cannot open " + slave_name_);
  termios raw{};
  if (::tcgetattr(slave_.get(), &raw) != 0) fail("cannot read the settings of " + slave_name_);
  ::cfmakeraw(&raw);
  if (::tcsetattr(slave_.get(), TCSANOW, &raw) != 0) fail("cannot set " + slave_name_ + " to raw mode");
  watch_ = Descriptor(::inotify_init1(IN_NONBLOCK | IN_CLOEXEC));
  if (watch_.get() < 0 || ::inotify_add_watch(watch_.get(), slave_name_.c_str(), IN_CLOSE) < 0)
    fail("cannot watch " + slave_name_);
  make_link(link_, slave_name_, terminals);
}

Pty::~Pty() {
  std::error_code ignored;
  // Only our own link: another simulator may have taken the name over.
  if (std::filesystem::read_symlink(link_, ignored) == slave_name_) std::filesystem::remove(link_, ignored);
}

std::vector<std::uint8_t> Pty::read() {
  user_closed();  // first: what the last user left unread goes before the next one's request is answered
  std::vector<std::uint8_t> bytes(4096);
  const ssize_t got = ::read(master_.get(), bytes.data(), bytes.size());
  bytes.resize(got > 0 ? static_cast<std::size_t>(got) : 0);
  return bytes;
}

void Pty::write(std::span<const std::uint8_t> bytes) {
  while (!bytes.empty()) {
    const ssize_t put = ::write(master_.get(), bytes.data(), bytes.size());
    if (put < 0 && errno == EINTR) continue;
    if (put <= 0) return;
    bytes = bytes.subspan(static_cast<std::size_t>(put));
  }
}

void Pty::user_closed() {
  std::array<char, 4096> events{};
  if (::read(watch_.get(), events.data(), events.size()) <= 0) return;
  (void)::ioctl(slave_.get(), TIOCNXCL);
  (void)::tcflush(slave_.get(), TCIFLUSH);
}

}  // namespace axisgate::simulated
