// What `--line` says: where the pty's link goes, what is spoken there and which drives hang on the line.
// Promises messages that name the word which is wrong and what would be right.
// Never opens anything.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tests/simulated/rtu_line.hpp"

namespace axisgate::simulated {

struct LineSpec {
  std::string path;  // of the link
  std::string name;  // its last part; how --fault and the control socket call the line
  bool rtu = false;  // Modbus RTU; else Kinco's own protocol
  std::vector<DriveOptions> drives;
  std::vector<RtuDriveOptions> rtu_drives;

  // The station or unit of each drive, in order.
  std::vector<std::uint8_t> stations() const;
  // "jd@1,md@2" or "rtu:jd@1,id286pro@2", as the ready line shows it.
  std::string describe() const;
};

// PATH:TYPE@STATION[+fresh][+cascade][+home=FROM..TO][+limits=FROM..TO],... for Kinco's protocol, types jd and md;
// PATH:rtu:TYPE@UNIT[+fresh][+home=FROM..TO][+limits=FROM..TO][+errors=83][+REGISTER=VALUE],... for Modbus RTU, types
// jd, md and id286pro. Throws std::invalid_argument. `common` is what all drives share.
LineSpec parse_line_spec(std::string_view text, const DriveOptions& common);

}  // namespace axisgate::simulated
