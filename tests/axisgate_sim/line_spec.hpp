// What `--line` says: where the pty's link goes and which drives hang on the line.
// Promises messages that name the word which is wrong and what would be right.
// Never opens anything.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "tests/simulated/drive_options.hpp"

namespace axisgate::simulated {

struct LineSpec {
  std::string path;  // of the link
  std::string name;  // its last part; how --fault and the control socket call the line
  std::vector<DriveOptions> drives;
};

// PATH:TYPE@STATION[+fresh][+cascade][+home=FROM..TO][+limits=FROM..TO],... Throws std::invalid_argument.
// `common` is what all drives share.
LineSpec parse_line_spec(std::string_view text, const DriveOptions& common);

// "jd@1,md@2", as the ready line shows it.
std::string describe(const std::vector<DriveOptions>& drives);

}  // namespace axisgate::simulated
