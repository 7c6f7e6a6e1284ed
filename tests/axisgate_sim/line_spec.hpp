// SPDX-License-Identifier: Apache-2.0
// What `--line` says: where the pty's link goes or which interface is used, what is spoken there and which drives hang
// on the line. Promises messages that name the word which is wrong and what would be right. Never opens anything.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tests/simulated/can_line.hpp"
#include "tests/simulated/keya_line.hpp"
#include "tests/simulated/rtu_line.hpp"

namespace axisgate::simulated {

// Kinco's own protocol, Modbus RTU and Keya's two serial ones on a pty; CANopen and Keya's CAN protocol on a SocketCAN
// interface, or behind a Lawicel adapter on a pty.
enum class LineKind : std::uint8_t { kinco, rtu, can, lawicel, keya_rs232, keya_rs485 };

struct LineSpec {
  std::string path;  // of the link, or the interface
  std::string name;  // its last part; how --fault and the control socket call the line
  LineKind kind = LineKind::kinco;
  std::vector<DriveOptions> drives;
  std::vector<RtuDriveOptions> rtu_drives;
  std::vector<CanDriveOptions> can_drives;
  std::vector<KeyaOptions> keya_drives{};
  bool is_can() const { return kind == LineKind::can || kind == LineKind::lawicel; }
  bool is_keya_serial() const { return kind == LineKind::keya_rs232 || kind == LineKind::keya_rs485; }

  // The station or unit of each drive, in order.
  std::vector<std::uint8_t> stations() const;
  // "jd@1,md@2", "rtu:jd@1,id286pro@2" or "can:ld2@1", as the ready line shows it.
  std::string describe() const;
};

// PATH:TYPE@STATION[+fresh][+cascade][+home=FROM..TO][+limits=FROM..TO],... for Kinco's protocol, types jd and md;
// PATH:rtu:TYPE@UNIT[+fresh][+home=FROM..TO][+limits=FROM..TO][+errors=83][+REGISTER=VALUE],... for Modbus RTU, types
// jd, md, id286pro, em2rs, cs2rs and zlac8015d;
// IFACE:can:TYPE@NODE[+fresh][+home=FROM..TO][+limits=FROM..TO][+block][+short]
// [+INDEX.SUB=VALUE],... for CANopen on a SocketCAN interface and PATH:lawicel:... behind a serial adapter, types jd,
// md, ld2, keya-can (its maker's protocol) and keya-kydas4860-2e (its CANopen mode). PATH:keya-rs232[OPTIONS],
// PATH:keya-rs485@NODE[OPTIONS],... and IFACE:keya-can@NODE[OPTIONS],... need no mark; keya_words.hpp has a Keya's
// options. Throws std::invalid_argument. `common` is what all drives share.
LineSpec parse_line_spec(std::string_view text, const DriveOptions& common);

}  // namespace axisgate::simulated
