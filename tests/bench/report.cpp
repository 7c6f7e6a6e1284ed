// SPDX-License-Identifier: Apache-2.0
#include "tests/bench/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <stdexcept>

namespace axisgate::bench {
namespace {

double load_of_the_machine() {
  std::array<double, 1> load{};
  return ::getloadavg(load.data(), 1) == 1 ? load[0] : std::nan("");
}

/// Two decimals below ten, one below a hundred, none above.
std::string shown(double figure) {
  const double size = std::abs(figure);
  return fmt::format("{:.{}f}", figure, size < 10 ? 2 : size < 100 ? 1 : 0);
}

std::string in_json(double figure) { return std::isfinite(figure) ? fmt::format("{:.6g}", figure) : "null"; }

}  // namespace

double quantile(Samples samples, double share) {
  if (samples.empty()) throw std::runtime_error("a figure has no samples");
  const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(samples.size())));
  const auto at = samples.begin() + static_cast<std::ptrdiff_t>(std::clamp<std::size_t>(rank, 1, samples.size()) - 1);
  std::nth_element(samples.begin(), at, samples.end());
  return *at;
}

double median(const Samples& samples) { return quantile(samples, 0.5); }
double worst(const Samples& samples) { return quantile(samples, 1); }
void append(Samples& to, const Samples& more) { to.insert(to.end(), more.begin(), more.end()); }

Report::Report(const std::string& json) : json_(json.empty() ? nullptr : std::fopen(json.c_str(), "a")) {
  if (!json.empty() && json_ == nullptr) throw std::runtime_error("cannot write " + json);
}

Report::~Report() {
  if (json_ != nullptr) std::fclose(json_);
}

void Report::row(std::string_view what, double axisgate, std::optional<Beside> beside) {
  const double load = load_of_the_machine();
  const double ratio = beside ? axisgate / beside->figure : std::nan("");
  fmt::print("{:<16} {:<58} {:>9} {:>9} {:<12} {:>7} {:>6.2f}\n", bench_, what, shown(axisgate),
             beside ? shown(beside->figure) : "-", beside ? beside->what : "", beside ? shown(ratio) : "-", load);
  std::fflush(stdout);
  if (json_ == nullptr) return;
  // No word of a bench has a quotation mark or a backslash.
  fmt::print(json_, R"({{"bench": "{}", "what": "{}", "axisgate": {}, "beside": {}, "figure": {}, "ratio": {},)",
             bench_, what, in_json(axisgate), beside ? fmt::format("\"{}\"", beside->what) : "null",
             in_json(beside ? beside->figure : std::nan("")), in_json(ratio));
  fmt::print(json_, " \"load\": {}}}\n", in_json(load));
  std::fflush(json_);
}

void Report::rows(std::string_view what, const Samples& axisgate, std::string_view beside_what, const Samples& beside,
                  int parts) {
  for (const auto& [name, share] : {std::pair{"median", 0.5}, std::pair{"p99", 0.99}})
    row(fmt::format("{}, {}", what, name), quantile(axisgate, share) / parts,
        Beside{beside_what, quantile(beside, share) / parts});
}

}  // namespace axisgate::bench
