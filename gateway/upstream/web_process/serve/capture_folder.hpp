// SPDX-License-Identifier: Apache-2.0
// The files of captures: one each, called by its id, in one folder. Promises that what is there under a capture's name
// is whole (it is renamed when it is written, 0640), that what is no capture is left alone and named in the log, and
// that no file, folder or disk ends the program: without them captures are in memory alone. Never opens a file once the
// process is confined, but one that is new.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "gateway/core/bytes.hpp"
#include "gateway/core/log.hpp"
#include "gateway/upstream/web_process/capture/recorder.hpp"

namespace axisgate::web {

/// Newest files that are looked at; more are left alone.
inline constexpr std::size_t kMostFiles = 1000;

class CaptureFolder {
 public:
  using Log = std::function<void(LogLevel, const std::string&)>;

  /// Makes the folder where only it is missing. @param path empty: there is none
  CaptureFolder(std::string path, Log log);
  ~CaptureFolder();
  CaptureFolder(const CaptureFolder&) = delete;
  CaptureFolder& operator=(const CaptureFolder&) = delete;

  /// Of the folder; -1: there is none.
  [[nodiscard]] int descriptor() const { return folder_; }
  /// What is there, before the process is confined. @param most bytes of a file that is read
  void restore(Recorder& recorder, std::size_t most);
  /// Nothing can be written.
  void close();
  /// Writes what is complete, then removes what is gone.
  void take(const Recorder::Turn& turn);

 private:
  struct Named {
    std::string name;
    std::int64_t changed = 0;
  };
  [[nodiscard]] std::vector<Named> names() const;
  /// False, and errno: it is not.
  [[nodiscard]] bool write(const Capture& capture) const;

  const std::string path_;
  const Log log_;
  int folder_ = -1;
  bool failing_ = false;  ///< the log says so already
};

}  // namespace axisgate::web
