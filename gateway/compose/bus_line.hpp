// SPDX-License-Identifier: Apache-2.0
// One bus of the gateway with its drives and their axes in the image: what a reload adds and takes away.
// Promises that its axes are in the image from its making until retire(), and that nothing of another bus is touched by
// either. Never opens a device itself: the wire is handed in.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "adapters/bus/bus.hpp"
#include "gateway/config/config.hpp"
#include "gateway/drive/device/drive.hpp"
#include "gateway/image/events.hpp"
#include "gateway/image/process_image.hpp"

namespace axisgate::compose {

using MakeWire =
    std::function<std::unique_ptr<bus::Wire>(const config::BusConfig&, const std::vector<model::DriveModel>&)>;

class BusLine {
 public:
  /// What a bus line works with; outlives it.
  struct Surroundings {
    Runtime& runtime;
    const Log& log;
    ProcessImage& image;
    EventRing& events;
  };
  /// `models` were checked together with `config`. `place`: of the bus in the configuration.
  BusLine(const config::BusConfig& config, const std::vector<model::DriveModel>& models, std::size_t place,
          const MakeWire& make_wire, const Surroundings& with);

  void start() { bus_->start(); }
  /// Its axes leave the image; nothing but the end of the object may follow.
  void retire();
  /// The configuration has it at another place now.
  void move_to(std::size_t place);

  [[nodiscard]] bus::Bus& bus() { return *bus_; }
  [[nodiscard]] const std::string& name() const { return bus_->settings().name; }
  [[nodiscard]] const std::vector<std::unique_ptr<drive::Drive>>& drives() const { return drives_; }
  /// The bus's registers, as of now.
  void show(BusImage& shown) const;

 private:
  ProcessImage& image_;
  std::vector<std::unique_ptr<drive::Drive>> drives_;
  std::unique_ptr<bus::Bus> bus_;  ///< goes first: it calls the drives
};

}  // namespace axisgate::compose
