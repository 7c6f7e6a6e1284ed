#include "tests/bench/figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <thread>

namespace axisgate::bench {

double quantile(std::vector<double> samples, double share) {
  if (samples.empty()) throw std::runtime_error("a figure has no samples");
  const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(samples.size())));
  const auto at = samples.begin() + static_cast<std::ptrdiff_t>(std::clamp<std::size_t>(rank, 1, samples.size()) - 1);
  std::nth_element(samples.begin(), at, samples.end());
  return *at;
}

double median(const std::vector<double>& samples) { return quantile(samples, 0.5); }

std::string load_of_the_machine() {
  std::array<double, 3> load{};
  if (::getloadavg(load.data(), 3) != 3) return "load average unknown";
  return fmt::format("load average {:.2f} {:.2f} {:.2f}, {} processors", load[0], load[1], load[2],
                     std::thread::hardware_concurrency());
}

std::string shown(double figure) {
  const double size = std::abs(figure);
  return fmt::format("{:.{}f}", figure, size < 10 ? 2 : size < 100 ? 1 : 0);
}

}  // namespace axisgate::bench
