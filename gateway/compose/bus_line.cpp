// SPDX-License-Identifier: Apache-2.0
#include "gateway/compose/bus_line.hpp"

#include <algorithm>
#include <utility>

#include "gateway/config/adapter_names.hpp"

namespace axisgate::compose {

BusLine::BusLine(const config::BusConfig& config, const std::vector<model::DriveModel>& models, std::size_t place,
                 const MakeWire& make_wire, const Surroundings& with)
    : image_(with.image) {
  const std::uint32_t bit_rate = config::adapter::on_can(config.adapter) ? config.bitrate : 0;
  bus::BusSettings settings{config.name, config.timeout, config.min_gap, config.settle, bit_rate};
  bus_ =
      std::make_unique<bus::Bus>(std::move(settings), models.size(), make_wire(config, models), with.runtime, with.log);
  if (config.decode) bus_->set_decode(true);
  for (std::size_t d = 0; d < models.size(); ++d) {
    std::vector<AxisImage*> images;
    for (const model::AxisModel& axis : models[d].axes)
      images.push_back(&image_.add_axis(axis.number, axis.name, static_cast<std::uint8_t>(place)));
    drives_.push_back(std::make_unique<drive::Drive>(models[d], static_cast<DriveSlot>(d), std::move(images), *bus_,
                                                     with.runtime, with.events));
  }
}

void BusLine::retire() {
  for (const auto& drive : drives_)
    for (const model::AxisModel& axis : drive->model().axes) image_.remove_axis(axis.number);
}

void BusLine::move_to(std::size_t place) {
  for (const auto& drive : drives_)
    for (const model::AxisModel& axis : drive->model().axes)
      image_.find(axis.number)->bus = static_cast<std::uint8_t>(place);
}

void BusLine::show(BusImage& shown) const {
  const bus::Statistics s = bus_->statistics();
  bool suspect = false;
  Duration slowest{};
  for (const auto& drive : drives_) {
    suspect = suspect || drive->link_state() == LinkState::suspect || drive->link_state() == LinkState::offline;
    for (std::size_t a = 0; a < drive->axis_count(); ++a)
      slowest = std::max(slowest, drive->axis(static_cast<AxisSlot>(a)).cycle());
  }
  shown.name = name();
  shown.link = bus_->up() ? (suspect ? 2 : 1) : 0;
  shown.load_permille = bus_->load_permille();
  shown.cycle_ms = static_cast<std::uint16_t>(
      std::min<std::int64_t>(UINT16_MAX, std::chrono::duration_cast<std::chrono::milliseconds>(slowest).count()));
  shown.queue_depth = static_cast<std::uint16_t>(bus_->queue_depth());
  shown.requests = s.requests;
  shown.replies = s.replies;
  shown.timeouts = s.timeouts;
  shown.bad_frames = s.bad_frames;
  shown.late_replies = s.late_replies;
  shown.dropped_bytes = s.dropped_bytes;
  shown.refused = s.refused;
  shown.coalesced = s.coalesced;
  shown.superseded = s.superseded;
  shown.reconnects = s.reconnects;
  shown.echoes = s.echoes;
  const bus::Bus::Times times = bus_->times();
  shown.times = times.exchanges.by_class();
  shown.waits = times.waits.by_class();
  shown.busy = times.busy;
}

}  // namespace axisgate::compose
