// SPDX-License-Identifier: Apache-2.0
// The types of EdsDrive, one of each maker, as docs/drives tells where their numbers are from.
#pragma once

#include "tests/simulated/eds_drive_type.hpp"

namespace axisgate::simulated {

extern const EdsDriveType epos4_type;    // maxon EPOS4 50/15, firmware 0170h
extern const EdsDriveType nanotec_type;  // Nanotec C5-E-2-09, firmware FIR-v2213
extern const EdsDriveType technosoft_type;
extern const EdsDriveType elmo_gold_type;
extern const EdsDriveType elmo_simpliq_type;
extern const EdsDriveType trinamic_type;   // TMCM-1270
extern const EdsDriveType zeroerr_type;    // eRob, EDS V1.5
extern const EdsDriveType faulhaber_type;  // MCBL 300x CO, firmware 3150.67B

}  // namespace axisgate::simulated
