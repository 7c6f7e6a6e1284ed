// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/web_process/serve/capture_folder.hpp"

#include <dirent.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <optional>

#include "gateway/upstream/web_process/capture/capture_file.hpp"
#include "gateway/upstream/web_process/system/confinement.hpp"

namespace axisgate::web {
namespace {

/// While it is written.
constexpr std::string_view kPartSuffix = ".part";
constexpr mode_t kNotForOthers = 0027;
constexpr mode_t kFolderMode = 0750;
/// Files that one line of the log names.
constexpr std::size_t kNamed = 3;

class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  [[nodiscard]] int fd() const { return fd_; }

 private:
  int fd_;
};

bool has_id_and(std::string_view name, std::string_view suffix) {
  return name.ends_with(suffix) && is_capture_id(name.substr(0, name.size() - suffix.size()));
}

std::string file_name(std::string_view id) { return fmt::format("{}{}", id, kCaptureSuffix); }

bool write_all(int fd, Bytes bytes) {
  while (!bytes.empty()) {
    const ssize_t size = ::write(fd, bytes.data(), bytes.size());
    if (size < 0 && errno == EINTR) continue;
    if (size <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(size));
  }
  return true;
}

/// The bytes, or why there are none.
std::variant<std::vector<Byte>, std::string> read_file(int folder, const std::string& name, std::size_t most) {
  // What is no file, a pipe perhaps, makes nobody wait.
  const Descriptor file(openat(folder, name.c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
  struct stat status {};
  if (file.fd() < 0 || fstat(file.fd(), &status) != 0) return std::string(std::strerror(errno));
  if (!S_ISREG(status.st_mode)) return "it is no file";
  if (static_cast<std::uint64_t>(status.st_size) > most) return "it is longer than a capture can be";
  std::vector<Byte> bytes(static_cast<std::size_t>(status.st_size));
  std::size_t got = 0;
  while (got < bytes.size()) {
    const ssize_t size = ::read(file.fd(), bytes.data() + got, bytes.size() - got);
    if (size < 0 && errno == EINTR) continue;
    if (size < 0) return std::string(std::strerror(errno));
    if (size == 0) break;
    got += static_cast<std::size_t>(size);
  }
  bytes.resize(got);
  return bytes;
}

std::variant<Capture, std::string> read_capture(int folder, const std::string& name, std::size_t most) {
  const auto read = read_file(folder, name, most);
  if (const auto* why = std::get_if<std::string>(&read)) return *why;
  auto capture = capture_of(std::get<std::vector<Byte>>(read));
  const auto* const good = std::get_if<Capture>(&capture);
  if (good != nullptr && file_name(good->id) != name) return "it is the capture " + good->id;
  return capture;
}

}  // namespace

CaptureFolder::CaptureFolder(std::string path, Log log) : path_(std::move(path)), log_(std::move(log)) {
  if (path_.empty()) return;
  umask(kNotForOthers);
  mkdir(path_.c_str(), kFolderMode);
  folder_ = open(path_.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder_ >= 0 && faccessat(folder_, ".", W_OK | X_OK, 0) == 0) return;
  log_(LogLevel::warning, fmt::format("captures are in memory alone: {}: {}", path_, std::strerror(errno)));
}

CaptureFolder::~CaptureFolder() { close(); }

void CaptureFolder::close() {
  if (folder_ >= 0) ::close(std::exchange(folder_, -1));
}

std::vector<CaptureFolder::Named> CaptureFolder::names() const {
  std::vector<Named> out;
  const int copy = openat(folder_, ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  DIR* const listing = copy < 0 ? nullptr : fdopendir(copy);
  if (listing == nullptr) return out;
  while (const dirent* each = readdir(listing)) {
    const std::string name = each->d_name;
    if (has_id_and(name, kPartSuffix)) unlinkat(folder_, name.c_str(), 0);  // of one of us that was ended meanwhile
    struct stat status {};
    if (has_id_and(name, kCaptureSuffix) && fstatat(folder_, name.c_str(), &status, AT_SYMLINK_NOFOLLOW) == 0)
      out.push_back({name, std::int64_t{status.st_mtim.tv_sec} * kSecond + status.st_mtim.tv_nsec});
  }
  closedir(listing);
  std::ranges::sort(out, std::greater(), &Named::changed);
  return out;
}

void CaptureFolder::restore(Recorder& recorder, std::size_t most) {
  if (folder_ < 0) return;
  std::vector<std::string> left_alone;
  std::size_t looked = 0;
  for (const Named& each : names()) {
    auto capture = looked++ < kMostFiles ? read_capture(folder_, each.name, most)
                                         : std::variant<Capture, std::string>("there are too many");
    if (auto* good = std::get_if<Capture>(&capture))
      recorder.restore(std::move(*good));
    else
      left_alone.push_back(fmt::format("{} ({})", each.name, std::get<std::string>(capture)));
  }
  if (left_alone.empty()) return;
  const std::size_t more = left_alone.size() - std::min(left_alone.size(), kNamed);
  left_alone.resize(std::min(left_alone.size(), kNamed));
  log_(LogLevel::warning, fmt::format("in {} these are no captures, and are left alone: {}{}", path_,
                                      fmt::join(left_alone, ", "), more == 0 ? "" : fmt::format(" and {} more", more)));
}

bool CaptureFolder::write(const Capture& capture) const {
  const std::string part = fmt::format("{}{}", capture.id, kPartSuffix);
  // By their numbers: the C library would add flags and choose other calls, and the filter lets these alone pass.
  const Descriptor file(static_cast<int>(syscall(SYS_openat, folder_, part.c_str(), new_file_flags(), kNewFileMode)));
  if (file.fd() < 0) return false;
  if (write_all(file.fd(), file_of(capture)) &&
      syscall(SYS_renameat2, folder_, part.c_str(), folder_, file_name(capture.id).c_str(), 0) == 0)
    return true;
  const int why = errno;
  syscall(SYS_unlinkat, folder_, part.c_str(), 0);
  errno = why;
  return false;
}

void CaptureFolder::take(const Recorder::Turn& turn) {
  if (folder_ < 0) return;
  for (const Recorder::Kept& each : turn.completed) {
    const bool written = write(*each);
    if (written && failing_) log_(LogLevel::info, fmt::format("captures are written to {} again", path_));
    if (!written && !failing_)
      log_(LogLevel::warning, fmt::format("capture {} is in memory alone: it cannot be written to {}: {}", each->id,
                                          path_, std::strerror(errno)));
    failing_ = !written;
  }
  for (const std::string& id : turn.gone) syscall(SYS_unlinkat, folder_, file_name(id).c_str(), 0);
}

}  // namespace axisgate::web
