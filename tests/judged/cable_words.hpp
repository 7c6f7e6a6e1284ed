// SPDX-License-Identifier: Apache-2.0
// What is asked and answered on each kind of cable, read from its frames alone. Promises to know frames by the makers'
// sheets and CiA 301, and to use no codec of the gateway. Never remembers anything.
#pragma once

#include <optional>
#include <vector>

#include "tests/stage/subject.hpp"
#include "tests/stage/transcript.hpp"

namespace axisgate::test::judged {

enum class Tongue : std::uint8_t { kinco, rtu, canopen, keya_can, keya_rs232, keya_rs485 };
[[nodiscard]] Tongue tongue_of(Subject subject);
[[nodiscard]] constexpr bool on_can(Tongue t) { return t == Tongue::canopen || t == Tongue::keya_can; }

namespace sdo {
inline constexpr Byte kAbort = 0x80;
inline constexpr std::uint8_t kUpload = 2, kDownload = 1;  ///< command specifiers that name an object (CiA 301 7.2.4.3)
}  // namespace sdo

/// What one drive is asked for, and answers.
struct Request {
  Tongue tongue{};
  std::uint8_t node = 0;
  bool write = false;
  bool answered = true;      ///< Keya's control frame is not
  std::uint32_t object = 0;  ///< index and sub-index; register and 0; of a control frame 0
  std::uint32_t value = 0;   ///< written; of a control frame its enable code
  std::vector<Byte> bytes{};
};

/// None: nobody answers it with an answer of its own (process data, NMT, guarding, an abort).
[[nodiscard]] std::optional<Request> request_in(Tongue tongue, const CableFrame& frame);
/// As the drives of this line know a frame.
[[nodiscard]] bool is_whole(Tongue tongue, const CableFrame& frame);
/// `heard`: of what came since the request, on CAN this frame, else all bytes.
[[nodiscard]] bool is_over(const Request& request, const CableFrame& heard);
/// What ends an exchange from this side: an SDO abort to this node.
[[nodiscard]] bool is_abort_of(const Request& request, const CableFrame& frame);

[[nodiscard]] bool is_nmt_command(Tongue tongue, const CableFrame& frame);
/// CiA 301: a node that has just started owes nothing. Its number.
[[nodiscard]] std::optional<std::uint8_t> booted(Tongue tongue, const CableFrame& frame);

/// What may not happen twice because it was asked for once.
struct Deeds {
  std::uint8_t node = 0;
  bool starts = false;      ///< a start of a motion, a homing or a set_position
  bool enables = false;     ///< where `enabled_before` is right
  bool of_motor_b = false;  ///< of a Keya
  bool enabled_after = false;
};
/// `enabled_before`: what the request to this node before it, as far as it told, had left.
[[nodiscard]] Deeds deeds_of(Subject subject, const Request& request, bool enabled_before);

}  // namespace axisgate::test::judged
