// SPDX-License-Identifier: Apache-2.0
// Why the program cannot begin: the text says what to change, the code is what it ends with.
// Promises to be thrown while starting only, and caught in one place a command.
// Never crosses a turn of the loop.
#pragma once

#include <stdexcept>
#include <string>

namespace axisgate::program {

struct StartError : std::runtime_error {
  StartError(int code, const std::string& text) : std::runtime_error(text), exit_code(code) {}
  int exit_code;
};

}  // namespace axisgate::program
