// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/link/coder.hpp"

namespace axisgate::link {

std::string not_of_one_installation(std::string_view program) {
  return "axisgate and " + std::string(program) + " are not of one installation";
}

std::string text(DecodeError error, std::string_view program) {
  switch (error) {
    case DecodeError::none:
      return "good";
    case DecodeError::too_short:
      return "a packet without kind";
    case DecodeError::version:
      return "another version: " + not_of_one_installation(program);
    case DecodeError::kind:
      return "a kind of record that this version does not know";
    case DecodeError::length:
      return "a record of another length than its kind has";
  }
  return {};
}

}  // namespace axisgate::link
