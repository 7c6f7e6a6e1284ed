#include "tests/sim/world.hpp"

#include <algorithm>

namespace axisgate::test {
namespace {

constexpr std::size_t kMaxViolations = 5;
constexpr int kClients = 3;

/// Two lines with one drive each, or both drives in one RS232 chain, or two MDs on one RS485 line.
std::vector<GatewayStage::Line> kinco_lines(Random& random) {
  GatewayStage::Line jd = line_of(simulated::KincoType::jd, 1);
  GatewayStage::Line md = line_of(simulated::KincoType::md, 2);
  for (GatewayStage::Line* line : {&jd, &md}) {
    line->options.reply_delay = std::chrono::microseconds(100 + random.below(5000));
    if (random.chance(1, 2)) line->options.baud = 38400;
  }
  if (random.chance(1, 2)) return {jd, md};
  md.drives.front().options.station = 2;
  if (random.chance(1, 2)) {
    GatewayStage::Line rs485 = line_of(simulated::KincoType::md, 1);
    rs485.options = md.options;
    rs485.options.wiring = simulated::Wiring::rs485;
    rs485.drives.push_back(md.drives.front());
    return {rs485};
  }
  jd.drives.push_back(md.drives.front());
  for (StageDrive& drive : jd.drives) drive.options.cascade = true;
  return {jd};
}

/// Points that the iD286pro's manual leaves open, and an origin switch in half of the seeds.
simulated::Id286proOptions stepper(Random& random) {
  simulated::Id286proOptions options;
  options.speed_follows_register = random.chance(1, 2);
  options.command_reads_back = random.chance(1, 2);
  options.refuses_what_cannot_act = random.chance(1, 2);
  if (random.chance(1, 4)) options.most_registers = 2;
  if (random.chance(1, 2)) {
    options.stored = {{400, 11}};
    options.mechanics.home_from = -60'000;
    options.mechanics.home_to = -40'000;
  }
  return options;
}

simulated::KincoRtuDrive servo(simulated::KincoType type, std::uint8_t unit, Random& random) {
  simulated::KincoRtuDrive drive;
  drive.drive.type = type;
  drive.drive.station = unit;
  drive.rtu.read_error_function = random.chance(1, 2) ? 0x81 : 0x83;
  drive.rtu.answer_delay = std::chrono::microseconds(100 + random.below(5000));
  return drive;
}

/// An iD286pro, a JD and an MD on one line.
GatewayStage::Line rtu_line(Random& random, AxisNumber first) {
  GatewayStage::Line line = rtu_line_of(
      {stepper(random), servo(simulated::KincoType::jd, 2, random), servo(simulated::KincoType::md, 3, random)}, first);
  if (random.chance(1, 2)) line.rtu_options.baud = 115200;
  return line;
}

/// Points that the Leadshine's manual leaves open.
simulated::LeadshineOptions leadshine(std::uint8_t node, Random& random) {
  simulated::LeadshineOptions options;
  options.node = node;
  options.acknowledges_setpoints = random.chance(1, 2);
  options.ready_flag = random.chance(1, 2);
  options.needs_halt_edge = random.chance(1, 2);
  options.mode = random.chance(1, 2) ? 8 : 0;
  options.sends_emergencies = random.chance(1, 2);
  options.leaves_operational_on_loss = random.chance(1, 2);
  options.event_timer = random.chance(1, 2);
  if (random.chance(1, 4)) options.unmappable = {{0x606C, 0}, {0x6077, 0}};
  return options;
}

simulated::KincoCanDrive can_servo(simulated::KincoType type, std::uint8_t node, Random& random) {
  simulated::KincoCanDrive drive;
  drive.drive.type = type;
  drive.drive.station = node;
  drive.can.echoes_written = random.chance(1, 2);
  drive.can.short_frames = random.chance(1, 2);
  drive.can.stops_without_master = random.chance(1, 2);
  if (random.chance(1, 4)) drive.can.unmappable = {{0x606C, 0}, {0x6078, 0}};
  return drive;
}

/// A Leadshine, a JD and an MD on one bus.
GatewayStage::Line can_line(Random& random, AxisNumber first) {
  GatewayStage::Line line = can_line_of({leadshine(1, random), can_servo(simulated::KincoType::jd, 2, random),
                                         can_servo(simulated::KincoType::md, 3, random)},
                                        first);
  constexpr std::array<std::uint32_t, 3> kBitRates{125'000, 500'000, 1'000'000};
  line.can_options.bit_rate = kBitRates[static_cast<std::size_t>(random.below(kBitRates.size()))];
  line.can_options.reply_delay = std::chrono::microseconds(100 + random.below(5000));
  return line;
}

/// Kinco's own protocol, Modbus RTU, CANopen, or several of them.
std::vector<GatewayStage::Line> layout(Random& random) {
  constexpr std::uint64_t kSerial = 1, kRtu = 2, kCan = 4, kMixtures = 7;
  const std::uint64_t kinds = 1 + random.below(kMixtures);
  std::vector<GatewayStage::Line> lines;
  AxisNumber next = 1;
  if ((kinds & kSerial) != 0) {
    lines = kinco_lines(random);
    next = 3;
  }
  if ((kinds & kRtu) != 0) {
    lines.push_back(rtu_line(random, next));
    next = static_cast<AxisNumber>(next + 3);
  }
  if ((kinds & kCan) != 0) lines.push_back(can_line(random, next));
  return lines;
}

}  // namespace

World::World(std::uint64_t seed)
    : random_(seed), lines_(layout(random_)), stage_(lines_, seed), began_(stage_.runtime().now()) {
  for (std::size_t l = 0; l < lines_.size(); ++l) {
    if (!lines_[l].can_drives.empty())
      watch_can(l);
    else if (!lines_[l].rtu_drives.empty())
      watch_rtu(l);
    else
      watch_kinco(l);
  }
  nemesis_ = std::make_unique<Nemesis>(victims_, stage_.runtime(), random_.next());
  add_clients();
}

void World::watch_kinco(std::size_t line) {
  const auto report = [this](const std::string& what) { violated(what); };
  SimLink& link = stage_.link(line);
  const Duration timeout = stage_.gateway().bus(line).settings().timeout;
  cables_.push_back(std::make_unique<CableWatch>(link, stage_.runtime(), timeout, report));
  for (std::size_t d = 0; d < link.line().size(); ++d) {
    axes_.push_back({.number = static_cast<AxisNumber>(axes_.size() + 1)});
    drives_.push_back(
        std::make_unique<DriveWatch>(stage_.gateway(), link, d, axes_.back().number, asked_, stage_.runtime(), report));
  }
  victims_.push_back(victim(link, stage_.runtime()));
}

void World::watch_rtu(std::size_t line) {
  const auto report = [this](const std::string& what) { violated(what); };
  RtuLinkSim& link = stage_.rtu_link(line);
  const Duration timeout = stage_.gateway().bus(line).settings().timeout;
  rtu_cables_.push_back(std::make_unique<RtuCableWatch>(link, stage_.runtime(), timeout, report));
  for (std::size_t d = 0; d < link.line().size(); ++d) {
    const AxisNumber axis = lines_[line].rtu_drives[d].axis.number;
    const bool stepper = link.line().id286pro(d) != nullptr;
    axes_.push_back(stepper ? ClientAxis{axis, {19, 21}, 109, true} : ClientAxis{.number = axis, .an_object = 0x3200});
    rtu_drives_.push_back(
        std::make_unique<RtuDriveWatch>(stage_.gateway(), link, d, axis, asked_, stage_.runtime(), report));
    rtu_cables_.back()->also_tell([watch = rtu_drives_.back().get()](const RtuRequest& r) { watch->on_request(r); });
  }
  victims_.push_back(victim(link, stage_.runtime()));
}

void World::watch_can(std::size_t line) {
  const auto report = [this](const std::string& what) { violated(what); };
  CanLinkSim& link = stage_.can_link(line);
  const Duration timeout = stage_.gateway().bus(line).settings().timeout;
  can_cables_.push_back(std::make_unique<CanCableWatch>(link, stage_.runtime(), timeout, report));
  for (std::size_t d = 0; d < link.line().size(); ++d) {
    axes_.push_back({.number = lines_[line].can_drives[d].axis.number, .has_name = true});
    can_drives_.push_back(std::make_unique<CanDriveWatch>(stage_.gateway(), link, d, axes_.back().number, asked_,
                                                          stage_.runtime(), report));
    can_cables_.back()->also_tell([watch = can_drives_.back().get()](bool towards_drive, const can::CanFrame& frame) {
      watch->on_frame(towards_drive, frame);
    });
  }
  victims_.push_back(victim(link, stage_.runtime()));
}

void World::add_clients() {
  const modbus_tcp::SessionContext context{settings_, stage_.gateway().image(), stage_.gateway(), registry_,
                                           quiet_,    &stage_.runtime()};
  for (int c = 0; c < kClients; ++c)
    clients_.push_back(std::make_unique<ModbusClient>(context, stage_.runtime(), random_.next(),
                                                      static_cast<std::uint16_t>(50000 + c), axes_, asked_,
                                                      [this](const std::string& what) { violated(what); }));
}

World::~World() = default;

void World::violated(const std::string& what) {
  if (violations_.size() >= kMaxViolations) return;
  violations_.push_back("at " + std::to_string(elapsed_ms(began_, stage_.runtime().now())) + " ms: " + what);
}

void World::step(Instant until) {
  Instant next = std::min(until, stage_.runtime().now() + std::chrono::milliseconds(1));
  next = std::min(next, nemesis_->next_deed());
  for (const auto& client : clients_) next = std::min(next, client->next_action());
  stage_.runtime().advance_to(std::max(next, stage_.runtime().now()));
  const Instant now = stage_.runtime().now();
  if (nemesis_->next_deed() <= now) nemesis_->act();
  for (const auto& client : clients_)
    if (client->next_action() <= now) client->act();
  check();
}

void World::check() {
  for (const auto& drive : drives_) drive->check();
  for (const auto& drive : rtu_drives_) drive->check();
  for (const auto& drive : can_drives_) drive->check();
  for (std::size_t b = 0; b < stage_.gateway().bus_count(); ++b)
    if (stage_.gateway().bus(b).queue_depth() > bus::kMaxOrdersPerBus + 32) violated("I7: the queue is over its bound");
}

void World::run(Duration length) {
  const Instant end = stage_.runtime().now() + length;
  while (stage_.runtime().now() < end && violations_.empty()) step(end);
  if (starts() > asked_.starts) violated("I5: more moves were started than asked for");
}

std::uint64_t World::starts() const {
  std::uint64_t starts = 0;
  for (const auto& cable : cables_) starts += cable->starts();
  for (const auto& cable : rtu_cables_) starts += cable->starts();
  for (const auto& drive : rtu_drives_) starts += drive->starts();
  for (const auto& cable : can_cables_) starts += cable->starts();
  return starts;
}

void World::recover() {
  nemesis_->retire();
  // The longest pause between two probes of a mute drive is 200 timeouts.
  Duration longest{};
  for (std::size_t b = 0; b < stage_.gateway().bus_count(); ++b)
    longest = std::max(longest, 200 * stage_.gateway().bus(b).settings().timeout);
  const Instant online_by = stage_.runtime().now() + longest + std::chrono::seconds(6);
  while (stage_.runtime().now() < online_by && violations_.empty()) step(online_by);
  if (!violations_.empty()) return;  // the first one tells the story; the rest would be its consequences
  for (const auto& axis : stage_.gateway().image().axes())
    if (axis->link_state != LinkState::online)
      violated("I11: axis " + std::to_string(axis->number) + " is " + std::string(text(axis->link_state)) +
               " long after the last fault");
  for (const auto& client : clients_) client->retire();
  const Instant end = stage_.runtime().now() + std::chrono::seconds(10);
  while (stage_.runtime().now() < end && violations_.empty()) step(end);
  for (const auto& client : clients_)
    if (client->waiting()) violated("I4: a request never got its reply");
  for (const auto& axis : stage_.gateway().image().axes()) {
    if (axis->has(AxisInput::moving))
      violated("I12: axis " + std::to_string(axis->number) + " moves on after a quick stop");
    if (axis->axis_state != AxisState::stopping && axis->axis_state != AxisState::error_stop)
      violated("I12: axis " + std::to_string(axis->number) + " is not latched after a quick stop");
  }
}

std::uint64_t World::hash() const {
  std::uint64_t hash = 0;
  for (const auto& cable : cables_) hash = hash * 31 + cable->hash();
  for (const auto& cable : rtu_cables_) hash = hash * 31 + cable->hash();
  for (const auto& cable : can_cables_) hash = hash * 31 + cable->hash();
  for (const auto& client : clients_) hash = hash * 31 + client->hash();
  return hash;
}

std::string World::seen_on_can() const {
  std::pair<std::uint64_t, std::uint64_t> seen;
  for (const auto& drive : can_drives_) {
    seen.first += drive->looked_at().first;
    seen.second += drive->looked_at().second;
  }
  if (can_drives_.empty()) return "";
  return ", on CAN " + std::to_string(seen.first) + " values by SDO and " + std::to_string(seen.second) + " by TPDO";
}

std::string World::summary() {
  bus::Statistics s{};
  for (std::size_t b = 0; b < stage_.gateway().bus_count(); ++b) {
    const bus::Statistics one = stage_.gateway().bus(b).statistics();
    s.requests += one.requests;
    s.timeouts += one.timeouts;
    s.late_replies += one.late_replies;
    s.bad_frames += one.bad_frames;
  }
  return std::to_string(s.requests) + " exchanges, " + std::to_string(s.timeouts) + " timeouts, " +
         std::to_string(s.late_replies) + " late replies, " + std::to_string(s.bad_frames) + " bad frames, " +
         std::to_string(asked_.requests) + " client requests" + seen_on_can();
}

}  // namespace axisgate::test
