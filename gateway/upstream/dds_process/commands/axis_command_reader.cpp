// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/dds_process/commands/axis_command_reader.hpp"

#include "gateway/upstream/dds_link/stop_commands.hpp"
#include "gateway/upstream/dds_process/topics/to_idl.hpp"
#include "gateway/upstream/program/steady.hpp"

namespace axisgate::dds {
namespace {

namespace rtps = eprosima::fastrtps::rtps;

/// False: it has no data, as the end of an instance mostly has none. The last sample of an instance may come together
/// with its disposal, and says what any other says.
bool read(GuardedType<AxisCommandPubSubType>& type, rtps::CacheChange_t& change, AxisCommand& sample) {
  return change.serializedPayload.length > 0 && type.deserialize(&change.serializedPayload, &sample);
}

}  // namespace

AxisCommandReader::History::History(const CommandIntake& intake) : ReaderHistory(command_history()), intake_(intake) {}

bool AxisCommandReader::History::received_change(rtps::CacheChange_t* change, std::size_t missing) {
  const bool commands = intake_.has_room(false);
  const bool stops = intake_.has_room(true);
  const bool room = commands == stops ? commands : is_stop(*change) == stops;
  return room && ReaderHistory::received_change(change, missing);
}

bool AxisCommandReader::History::is_stop(rtps::CacheChange_t& change) {
  AxisCommand sample;
  // Of one in fragments only the first may be here.
  return change.is_fully_assembled() && read(type_, change, sample) && is_stop_command(sample.command());
}

AxisCommandReader::AxisCommandReader(RtpsParticipant& participant, CommandTopic topic, CommandIntake& intake,
                                     WriterWatch& watch, program::Wake& wake)
    : exclusive_(topic == CommandTopic::command),
      intake_(intake),
      watch_(watch),
      wake_(wake),
      history_(intake),
      reader_(participant.make_reader({topic, 0}, history_, *this)) {}

AxisCommandReader::~AxisCommandReader() { RtpsParticipant::end_reader(reader_); }

void AxisCommandReader::onReaderMatched(rtps::RTPSReader*, rtps::MatchingInfo& info) {
  const Guid writer = to_guid(info.remoteEndpointGuid);
  if (info.status == rtps::MATCHED_MATCHING) {
    watch_.on_matched(writer, program::steady_now());
  } else {
    watch_.on_unmatched(writer);
  }
  wake_.set();
}

void AxisCommandReader::onNewCacheChangeAdded(rtps::RTPSReader*, const rtps::CacheChange_t* change) {
  AxisCommand sample;
  // The library reads from its buffer with a pointer that may write, and removes what it has given us as const.
  auto* const mine = const_cast<rtps::CacheChange_t*>(change);
  if (read(type_, *mine, sample)) {
    const Guid writer = to_guid(change->writerGUID);
    const SteadyNs now = program::steady_now();
    watch_.on_sample(writer, now);
    const auto strength = static_cast<std::int32_t>(change->reader_info.writer_ownership_strength);
    intake_.add(
        to_record(sample, {writer, exclusive_ ? strength : 0, program::to_steady(change->sourceTimestamp.to_ns())}),
        now);
  }
  history_.remove_change(mine);
  wake_.set();
}

}  // namespace axisgate::dds
