// SPDX-License-Identifier: Apache-2.0
// How other threads tell the one that works that there is something to do: an eventfd.
// Promises that set() never blocks and may come from any thread, and that many of it are one wake-up.
// Never says what there is to do.
#pragma once

namespace axisgate::program {

class Wake {
 public:
  Wake();
  ~Wake();
  Wake(const Wake&) = delete;
  Wake& operator=(const Wake&) = delete;

  [[nodiscard]] int fd() const { return fd_; }
  void set();
  void clear();

 private:
  int fd_;
};

}  // namespace axisgate::program
