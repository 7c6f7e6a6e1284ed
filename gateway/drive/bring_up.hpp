// Bring-up of a drive (design 7, point 7): its state is read first; then everything the image needs, the checks, the
// setup. Promises that a drive found enabled is adopted: nothing is written to it; and that a setup value is written
// only where the drive holds another, and read back. Never enables, moves or stops anything.
#pragma once

#include <optional>
#include <vector>

#include "gateway/drive/object_store.hpp"
#include "gateway/drive/poll_plan.hpp"

namespace axisgate::drive {

class BringUp {
 public:
  explicit BringUp(const DriveModel& model);

  void begin();
  struct Next {
    ObjectId object = kNoObject;
    bool write = false;
    std::int64_t number = 0;
  };
  /// The next exchange; none: bring-up is over. The same answer until the store shows its effect.
  [[nodiscard]] std::optional<Next> next(const ObjectStore& store);
  /// The write given by next() was acknowledged, or its outcome is unknown: it is read back next.
  void written();
  /// The drive refused the write given by next().
  void write_refused();
  /// The read given by next() was a read-back, and it was answered.
  void read_back_answered() { read_back_ = false; }
  /// Some axis was found enabled.
  [[nodiscard]] bool adopted() const { return adopted_; }
  /// Setup values that the drive does not hold although they were written: they are named in an event.
  [[nodiscard]] const std::vector<ObjectId>& unheld() const { return unheld_; }
  [[nodiscard]] bool has_setup() const { return !model_.setup.empty(); }

 private:
  [[nodiscard]] bool any_enabled(const ObjectStore& store) const;
  const DriveModel& model_;
  std::vector<ObjectId> reads_;
  std::vector<ObjectId> confirmed_;  ///< class fast, the statuswords among them: read once more at the end
  std::size_t read_at_ = 0;
  std::optional<std::uint64_t> confirm_after_;  ///< exchange: the state is read once more before the first setup write
  std::size_t setup_at_ = 0;
  bool setup_written_ = false;
  bool read_back_ = false;
  bool adopted_ = false;
  std::vector<ObjectId> unheld_;
};

}  // namespace axisgate::drive
