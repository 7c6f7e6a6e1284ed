// SPDX-License-Identifier: Apache-2.0
// A nemesis at work: rates on axis 1's drive, clients beside those of the program, and when the event loop stands.
// Promises the same for the same seed, and that all of it has ended with its phase. Never writes anything that a
// gateway may carry out.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tests/judged/nemesis.hpp"

namespace axisgate::test::judged {

class Plague {
 public:
  /// The plant must outlive it.
  Plague(obey::Plant& plant, const Nemesis& nemesis, std::uint64_t seed)
      : plant_(plant), nemesis_(nemesis), random_(~seed) {}

  /// Before each 5 ms of the run. What was wrong with what its clients were told.
  [[nodiscard]] std::optional<std::string> rage(std::int64_t now_ms);
  [[nodiscard]] bool began() const { return began_; }
  /// The drive's exchanges are struck.
  [[nodiscard]] bool strikes_now() const { return strikes_; }
  /// For so long it stands from now on; 0: not at all. Each stall is told once.
  [[nodiscard]] Duration stalls_now() { return std::exchange(stall_, Duration{}); }
  void count_strikes();
  [[nodiscard]] const Injected& injected() const { return injected_; }

 private:
  void set_rates(bool on);
  [[nodiscard]] std::optional<std::string> cook();
  void throng();

  obey::Plant& plant_;
  const Nemesis nemesis_;
  simulated::Random random_;
  bool began_ = false, ended_ = false, strikes_ = false;
  Duration stall_{};
  Injected injected_;
  std::unique_ptr<obey::Client> cook_;  ///< of whole requests
  std::size_t owed_ = 0;                ///< replies to it
  std::int64_t owed_since_ms_ = 0, now_ms_ = 0;
  std::vector<std::unique_ptr<obey::Client>> crowd_;
};

}  // namespace axisgate::test::judged
