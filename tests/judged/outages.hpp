// SPDX-License-Identifier: Apache-2.0
// How a step's fields choose what befalls an exchange with axis 1's drive, and where in an exchange the gateway dies.
// Promises the same for equal steps. Never judges.
#pragma once

#include "tests/judged/program.hpp"
#include "tests/judged/watches.hpp"

namespace axisgate::test::judged {

/// Deed::lose, late and twice: an answer is lost, late or there twice, or is spoilt where the line carries bytes.
void strike(obey::Plant& plant, Watches& watches, const Step& step);
/// Deed::crash: at once, or after so many bytes or frames of what is sent from now on.
void begin_to_die(obey::Plant& plant, const Step& step);

}  // namespace axisgate::test::judged
