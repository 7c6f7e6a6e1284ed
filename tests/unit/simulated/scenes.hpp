// The scenes that scripts play in: simulated drives on each kind of line, driven by their own protocols.
// Promises that objects are named as the sheets print them: 60F9.19 in hex, a Kinco's register as r3200 or r3700L (two
// words), an iD286pro's register as 323; "@2" behind a name is another station. Never decides what is right.
#pragma once

#include "tests/unit/simulated/bench.hpp"

namespace axisgate::simulated {

template <class Options>
using Patch = std::function<void(Options&)>;

Maker kinco(KincoType type, const Patch<DriveOptions>& patch = {});
Maker kincos(const std::vector<DriveOptions>& drives, const Patch<LineOptions>& patch = {});
inline Maker jd(const Patch<DriveOptions>& patch = {}) { return kinco(KincoType::jd, patch); }
inline Maker md(const Patch<DriveOptions>& patch = {}) { return kinco(KincoType::md, patch); }

Maker rtu(const std::vector<RtuDriveOptions>& drives, const RtuLineOptions& line = no_line_timing());
Maker rtu_kinco(KincoType type, const Patch<KincoRtuDrive>& patch = {});
Maker id286pro(const Patch<Id286proOptions>& patch = {});

Maker can(const std::vector<CanDriveOptions>& drives, const CanLineOptions& line = no_can_timing());
Maker ld2(const Patch<LeadshineOptions>& patch = {});
Maker can_kinco(KincoType type, const Patch<KincoCanDrive>& patch = {});

Maker keya_own_can(const KeyaOptions& options = a_keya());
Maker keya_canopen(const KeyaOptions& options = a_keya());
Maker keya_serial(KeyaWiring wiring, const std::vector<KeyaOptions>& drives = {a_keya()});
// The same with a point that the manual leaves open: yes where the row's first word is 1.
Maker keya_own_can_if(bool KeyaOptions::*open, KeyaOptions options = a_keya());
Maker keya_serial_if(bool KeyaOptions::*open, KeyaWiring wiring, KeyaOptions options = a_keya());

}  // namespace axisgate::simulated
