// `axisgate profile check FILE`: validates a drive profile and says what it gives on each protocol.
// Promises every mistake at once, each with its file and place.
// Never asks a drive.
#pragma once

#include <string>

namespace axisgate::app {

struct ProfileCheckOptions {
  std::string file;
};

[[nodiscard]] int run(const ProfileCheckOptions& options);

}  // namespace axisgate::app
