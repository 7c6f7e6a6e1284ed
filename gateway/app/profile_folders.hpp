// Where shipped profiles lie: beside the build, beside the installed program, or in the system's place.
// Promises the folders in the order in which they are searched, the one given by the user first.
// Never creates one.
#pragma once

#include <string>
#include <vector>

namespace axisgate::app {

/// `given`: option --profiles, may be empty.
[[nodiscard]] std::vector<std::string> profile_folders(const std::string& given);

}  // namespace axisgate::app
