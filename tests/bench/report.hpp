// SPDX-License-Identifier: Apache-2.0
// The rows of the one table that benches print: a figure of axisgate's, what it is compared with, and their ratio.
// Promises a row as soon as it is known, on the screen and as a line of JSON, with the load of the machine at that
// time; and that a figure without samples is an error, so that an empty run never looks like a good one.
// Never judges: the reader compares.
#pragma once

#include <cstdio>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace axisgate::bench {

using Samples = std::vector<double>;

/// The smallest sample that `share` (0..1) of all do not exceed. Throws std::runtime_error without samples.
[[nodiscard]] double quantile(Samples samples, double share);
[[nodiscard]] double median(const Samples& samples);
[[nodiscard]] double worst(const Samples& samples);
void append(Samples& to, const Samples& more);

/// What a figure is compared with.
struct Beside {
  std::string_view what;
  double figure;
};
[[nodiscard]] inline Beside bare(double figure) { return {"bare loop", figure}; }
[[nodiscard]] inline Beside goal(double figure) { return {"goal", figure}; }

class Report {
 public:
  /// `json`: a file that rows are added to; empty: none. Throws std::runtime_error.
  explicit Report(const std::string& json);
  ~Report();
  Report(const Report&) = delete;
  Report& operator=(const Report&) = delete;

  /// Rows are this bench's from now on.
  void begin(std::string_view bench) { bench_ = bench; }
  /// `what` ends with the figure's unit.
  void row(std::string_view what, double axisgate, std::optional<Beside> beside = {});
  /// Two rows: medians, and what 99 of 100 samples do not exceed. A sample is that of `parts` alike.
  void rows(std::string_view what, const Samples& axisgate, std::string_view beside_what, const Samples& beside,
            int parts = 1);

 private:
  std::string bench_;
  std::FILE* json_ = nullptr;
};

}  // namespace axisgate::bench
