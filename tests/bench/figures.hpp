// What the benches print: quantiles of samples, and how busy the machine was.
// Promises that a figure without samples is an error, so that an empty run never looks like a good one.
// Never judges: goals stand in the output, the reader compares.
#pragma once

#include <string>
#include <vector>

namespace axisgate::bench {

/// The smallest sample that `share` (0..1) of all do not exceed. Throws std::runtime_error without samples.
[[nodiscard]] double quantile(std::vector<double> samples, double share);
[[nodiscard]] double median(const std::vector<double>& samples);

/// "load average 0.10 0.20 0.30, 2 processors"
[[nodiscard]] std::string load_of_the_machine();

/// Two decimals below ten, one below a hundred, none above.
[[nodiscard]] std::string shown(double figure);

}  // namespace axisgate::bench
