#include "tests/judged/play.hpp"

#include <algorithm>
#include <cstdlib>

#include "tests/judged/history.hpp"
#include "tests/judged/writers.hpp"

namespace axisgate::test::judged {
namespace {

using namespace std::chrono_literals;
using namespace model;
using obey::Answer;
using obey::Client;
using obey::Plant;
using obey::PlantOptions;

constexpr std::int64_t kStepMs = 5;
constexpr std::int64_t kSilenceMs = 10'000;    // no request is unanswered for so long (3.3: reply_deadline_ms 900)
constexpr std::int64_t kComebackMs = 150'000;  // from the end of the last fault to an axis online (7.3: 60 s and more)
constexpr std::int64_t kOnlineMs = 1'200;      // so long online: what was late has come
constexpr std::int64_t kTailMs = 6'000;        // after the last step
constexpr std::array kStrikes{obey::Strike::lose_request, obey::Strike::lose_reply, obey::Strike::late_reply,
                              obey::Strike::double_reply};
constexpr std::int64_t kJogSpeed = 45'000;

class Play {
 public:
  Play(const Program& program, std::uint64_t seed)
      : program_(program), plant_(program.subject, options_of(program, seed)), clients_{&plant_.a, &plant_.b} {}

  Outcome run();

 private:
  static PlantOptions options_of(const Program& program, std::uint64_t seed) {
    PlantOptions options;
    if (program.leases) options.lease = LeaseRules{};
    options.seed = seed;
    return options;
  }
  struct Open {
    int request = 0;
    std::size_t client = 0;
    obey::RequestNumber number = 0;
    std::int64_t sent_ms = 0;
    std::size_t line = 0;
  };

  [[nodiscard]] std::int64_t now_ms() { return elapsed_ms(began_, plant_.stage.runtime().now()); }
  void begin();
  void act(const Step& step);
  void send(std::size_t client, Write write, bool at_once);
  void outage(const Step& step);
  void pass(std::int64_t ms);
  void look();
  void collect();
  void watch_trouble();
  void begin_trouble();
  void mend();
  void reconnect(std::size_t client, bool silently);
  void read(std::size_t client);
  void violated(std::string what);
  [[nodiscard]] bool over() const { return outcome_.violation.has_value(); }
  [[nodiscard]] std::string stamp();

  Program program_;
  Plant plant_;
  std::array<Client*, kClients> clients_;
  std::optional<Writers> writers_;
  std::optional<Contract> contract_;
  Outcome outcome_;
  Instant began_{};
  std::vector<Open> open_;
  History seen_;
  bool wire_whole_ = true;
  bool had_outage_ = false;
  std::int64_t whole_since_ms_ = 0;
  std::int64_t online_since_ms_ = -1;
};

std::string Play::stamp() {
  const obey::Truth truth = plant_.motor();
  return std::to_string(now_ms()) + " ms, at " + std::to_string(truth.position) +
         (truth.velocity != 0 ? " turning at " + std::to_string(truth.velocity) : "") +
         (truth.enabled ? *truth.enabled ? "" : " (off)" : "") + (truth.faulted ? " (faulted)" : "");
}

void Play::violated(std::string what) {
  if (over()) return;
  outcome_.violation = stamp() + ": " + std::move(what);
}

void Play::begin() {
  plant_.ready();
  writers_.emplace(program_, plant_.profile_rows());
  const Subject subject = program_.subject;
  ContractOptions options;
  options.leases = program_.leases;
  options.no_halt = obey::is_kinco(subject) && !obey::is_md(subject) && program_.flavour != Flavour::speeds;
  options.by_gateway = !obey::is_cia402(subject);
  if (obey::has_positions(subject)) options.rows.insert(row::target_position);
  if (obey::has_speeds(subject)) options.rows.insert(row::target_velocity);
  options.rows.insert(row::mode);
  World world;
  if (obey::has_speeds(subject)) {
    const auto fitter = plant_.connection_from(Plant::kHostOfFitter);
    if (!fitter->row(row::jog_velocity, kJogSpeed).ok()) violated("jog_velocity was refused");
    fitter->command(kRelease);
    world.accepted[row::jog_velocity] = kJogSpeed;
  }
  began_ = plant_.stage.runtime().now();
  const obey::Truth truth = plant_.motor();
  world.enabled = true;
  if (program_.leases) {  // it was released: the lease is open, and began a moment ago
    world.lease_until(options.lease_ms - (obey::has_speeds(subject) ? 0 : 100));
  }
  contract_.emplace(options, world);
  const Sight sight{0, truth.position, truth.velocity, truth.enabled, truth.faulted};
  seen_.add(sight);
  static_cast<void>(contract_->see(sight));
}

Outcome Play::run() {
  begin();
  if (program_.flavour != Flavour::both && obey::has_positions(program_.subject) && obey::has_speeds(program_.subject))
    send(0, one(row::mode, program_.flavour == Flavour::moves ? 1 : kVelocityMode), false);
  for (const Step& step : program_.steps) {
    if (over()) break;
    act(step);
  }
  mend();
  for (const obey::Strike how : kStrikes) plant_.strike(how, 0);
  for (std::int64_t waited = 0; !over() && (contract_->in_trouble() || waited < kTailMs); waited += kStepMs) {
    pass(kStepMs);
    if (waited > kComebackMs + kTailMs) violated("the axis never came back online");
  }
  outcome_.virtual_ms = now_ms();
  outcome_.lost_count = contract_->lost_count();
  if (over()) outcome_.story.push_back(*outcome_.violation);
  return std::move(outcome_);
}

void Play::send(std::size_t client, Write write, bool at_once) {
  if (over() || !clients_[client]->connected()) return;
  writers_->sent(client, write);
  const std::string before = stamp();
  const int request = contract_->send(client, write);
  ++outcome_.requests;
  const auto number = clients_[client]->begin(write);
  outcome_.story.push_back(before + ": " + (client == 0 ? "a " : "b ") + text(write) + "  -> " +
                           contract_->predicted());
  open_.push_back({request, client, number, now_ms(), outcome_.story.size() - 1});
  collect();
  while (!at_once && !over() && std::ranges::any_of(open_, [&](const Open& open) { return open.request == request; }))
    pass(kStepMs);
}

void Play::collect() {
  std::erase_if(open_, [this](const Open& open) {
    if (over()) return false;
    std::string& line = outcome_.story[open.line];
    if (const std::optional<Answer> answer = clients_[open.client]->answer_of(open.number)) {
      line += answer->ok() ? "  [ok]" : "  [exception " + std::to_string(answer->exception) + "]";
      const std::string expected = contract_->expected();
      if (!contract_->answered(open.request, answer->exception)) {
        line += "  <-- NO READING HAS THIS ANSWER";
        violated("no reading has this answer; expected: " + expected);
      } else {
        line += "\n      then: " + contract_->expected();
      }
      return true;
    }
    if (!clients_[open.client]->connected()) {
      contract_->unanswered(open.request);
      return true;
    }
    if (now_ms() - open.sent_ms > kSilenceMs) violated("a request was never answered: " + line);
    return false;
  });
}

void Play::look() {
  const obey::Truth truth = plant_.motor();
  const std::string expected = over() ? "" : contract_->expected();
  const Sight sight{now_ms(), truth.position, truth.velocity, truth.enabled, truth.faulted};
  seen_.add(sight);
  if (!contract_->see(sight))
    violated("the motor does what nobody asked for: velocity " + std::to_string(truth.velocity) +
             "; the contract: " + expected);
}

void Play::watch_trouble() {
  if (!wire_whole_) return;
  const bool online = plant_.stage.gateway_runs() && plant_.stage.axis(1).link_state == LinkState::online;
  if (!contract_->in_trouble()) {
    if (online) return;
    // What was adopted is brought up as soon as it is disabled (section 7, point 7); else nothing takes an axis away.
    if (!had_outage_) violated("the axis is not online any more, and nothing has happened to it");
    begin_trouble();
    return;
  }
  const bool strikes = std::ranges::any_of(kStrikes, [this](obey::Strike how) { return plant_.still_strikes(how); });
  if (!online || strikes) {
    online_since_ms_ = -1;
    return;
  }
  if (online_since_ms_ < 0) online_since_ms_ = now_ms();
  if (now_ms() - std::max(online_since_ms_, whole_since_ms_) < kOnlineMs) return;
  outcome_.story.push_back(stamp() + ": all is well again");
  contract_->trouble_ends();
}

void Play::begin_trouble() {
  had_outage_ = true;
  contract_->trouble_begins();
  online_since_ms_ = -1;
}

void Play::pass(std::int64_t ms) {
  for (std::int64_t gone = 0; gone < ms && !over(); gone += kStepMs) {
    plant_.run(std::chrono::milliseconds(kStepMs));
    look();
    collect();
    watch_trouble();
  }
}

void Play::reconnect(std::size_t client, bool silently) {
  for (const Open& open : open_)
    if (open.client == client) contract_->unanswered(open.request);
  std::erase_if(open_, [&](const Open& open) { return open.client == client; });
  if (silently)
    clients_[client]->vanish();
  else
    clients_[client]->disconnect();
  contract_->left(client, silently);
  clients_[client]->connect();
  outcome_.story.push_back(stamp() + ": " + (client == 0 ? "a" : "b") + (silently ? " vanishes" : " reconnects"));
}

// 3.2: what is shown as valid was true at its age.
void Play::read(std::size_t client) {
  if (!clients_[client]->connected()) return;
  look();
  constexpr std::size_t kSequence = 24;
  constexpr unsigned kBitOfStatusword = 0, kBitOfPosition = 2;
  contract_->asked(client);
  const std::vector<std::uint16_t> words = clients_[client]->read(0, kSequence);
  look();
  const auto wide = [&](std::size_t at) { return std::uint32_t{words[at]} << 16 | words[at + 1]; };
  const std::uint32_t valid = wide(obey::shown::supported + 2);
  const std::int64_t age_ms = words[obey::shown::supported - 1];
  if ((valid >> kBitOfPosition & 1U) != 0) {
    const auto position = static_cast<std::int32_t>(wide(obey::shown::position));
    if (!seen_.was_at(position, age_ms))
      violated("position " + std::to_string(position) + " is shown as valid, " + std::to_string(age_ms) +
               " ms old, and the motor was elsewhere");
  }
  if ((valid >> kBitOfStatusword & 1U) != 0 && obey::is_cia402(program_.subject)) {
    constexpr std::uint16_t kStateBits = 0x6F, kOperationEnabled = 0x27;
    const bool enabled = (words[obey::shown::statusword] & kStateBits) == kOperationEnabled;
    if (!seen_.was_enabled(enabled, age_ms))
      violated(std::string("the axis is shown as ") + (enabled ? "enabled" : "not enabled") + ", " +
               std::to_string(age_ms) + " ms old, and was not");
  }
}

void Play::outage(const Step& step) {
  const std::int64_t length = kLengths.at(step.length);
  outcome_.story.push_back(stamp() + ": " + text(step) + " " + std::to_string(length) + " ms");
  if (!wire_whole_) return;
  begin_trouble();
  switch (step.deed) {
    case Deed::cut:
      wire_whole_ = false;
      plant_.cut_wire();
      break;
    case Deed::unplug:
      wire_whole_ = false;
      plant_.unplug();
      break;
    case Deed::lose:
      plant_.strike(step.on ? obey::Strike::lose_request : obey::Strike::lose_reply, 1 + step.number % 4);
      break;
    case Deed::late:
      plant_.strike(obey::Strike::late_reply, 1 + step.number % 3);
      break;
    case Deed::twice:
      plant_.strike(obey::Strike::double_reply, 1 + step.number % 3);
      break;
    case Deed::restart:
      contract_->drive_restarted();
      plant_.restart_drive(std::chrono::milliseconds(step.on ? length : 0));
      break;
    case Deed::trip:
      contract_->drive_tripped();
      plant_.trip_drive();
      break;
    default:
      wire_whole_ = false;
      contract_->gateway_died();
      open_.clear();
      plant_.crash_gateway();
  }
  if (step.at_once && step.deed != Deed::crash) return;
  pass(length);
}

void Play::act(const Step& step) {
  switch (step.deed) {
    case Deed::wait:
      break;
    case Deed::read:
      read(step.client);
      break;
    case Deed::reconnect:
    case Deed::vanish:
      reconnect(step.client, step.deed == Deed::vanish);
      break;
    case Deed::scan:
      for (std::int64_t gone = 0; gone < kLengths.at(step.length) && gone < 1500 && !over(); gone += 50) {
        send(step.client, writers_->write_of(step), step.at_once);
        pass(50);
      }
      break;
    case Deed::button: {
      if (!obey::has_speeds(program_.subject)) break;
      const std::uint16_t number = step.number % 2 == 0 ? coil::jog_forward : coil::jog_reverse;
      send(step.client, one_coil(number, false), false);
      for (std::int64_t gone = 0; gone <= kLengths.at(step.length) && gone < 1500 && !over(); gone += 200) {
        send(step.client, one_coil(number, true), step.at_once);
        pass(200);
      }
      if (step.on) send(step.client, one_coil(number, false), false);
      break;
    }
    case Deed::cut:
    case Deed::unplug:
    case Deed::lose:
    case Deed::late:
    case Deed::twice:
    case Deed::restart:
    case Deed::trip:
    case Deed::crash:
      outage(step);
      break;
    default:
      send(step.client, writers_->write_of(step), step.at_once);
  }
  pass(kPauses.at(step.pause));
  if (step.number % 3 == 0 || !step.at_once) mend();
}

void Play::mend() {
  if (wire_whole_ || over()) return;
  plant_.plug();
  plant_.mend_wire();
  if (!plant_.stage.gateway_runs()) {
    plant_.start_gateway();
    contract_->gateway_started();
    for (Client* client : clients_) client->connect();
  }
  wire_whole_ = true;
  whole_since_ms_ = now_ms();
  outcome_.story.push_back(stamp() + ": it is mended");
}

}  // namespace

Outcome play(const Program& program, std::uint64_t seed) { return Play(program, seed).run(); }

}  // namespace axisgate::test::judged
