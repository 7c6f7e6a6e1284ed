// SPDX-License-Identifier: Apache-2.0
// An image whose axes change at a steady rate, and the gateway's half of the DDS server over it, on a thread of its
// own. Promises that each change is stamped when it is made. Never has a drive behind it: what is measured begins at
// the image. Never takes commands.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <memory>

namespace axisgate::bench {

struct ChangingAxes {
  std::uint32_t domain = 0;
  int axes = 1;
  std::chrono::microseconds every{2000};  ///< all of them, one after another over this time
  std::chrono::milliseconds min_period{1};
};

class ChangingImage {
 public:
  /// Returns when axisgate-dds runs. `program`: its path.
  explicit ChangingImage(const ChangingAxes& shape);
  ~ChangingImage();
  ChangingImage(const ChangingImage&) = delete;
  ChangingImage& operator=(const ChangingImage&) = delete;

  /// Pausing leaves the processes and their topics as they are.
  void change(bool on);
  [[nodiscard]] std::uint64_t changes() const;
  [[nodiscard]] pid_t process() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace axisgate::bench
