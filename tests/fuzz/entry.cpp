// SPDX-License-Identifier: Apache-2.0
// libFuzzer's way into one target.
#include "tests/fuzz/targets.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return AXISGATE_FUZZ_TARGET(data, size);
}
