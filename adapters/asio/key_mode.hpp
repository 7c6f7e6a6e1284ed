// SPDX-License-Identifier: Apache-2.0
// A person's terminal while its keys are buttons: each key comes at once, and is not shown.
// Promises that the terminal is as it was found once this is gone, and that Ctrl-C is a signal as ever. Never leaves
// Ctrl-Z and Ctrl-S in force: a program that stands still lets go of no button.
#pragma once

#include <boost/noncopyable.hpp>
#include <memory>

namespace axisgate {

class KeyMode : boost::noncopyable {
 public:
  /// `descriptor` is a terminal, and outlives this.
  explicit KeyMode(int descriptor);
  ~KeyMode();

  /// Keys that were pressed and not read yet are gone.
  void forget_keys() const;

 private:
  struct Found;
  int descriptor_;
  std::unique_ptr<Found> found_;  ///< null: it could not be asked, and is left alone
};

}  // namespace axisgate
