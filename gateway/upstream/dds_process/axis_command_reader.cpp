// SPDX-License-Identifier: Apache-2.0
#include "gateway/upstream/dds_process/axis_command_reader.hpp"

#include <fastdds/rtps/RTPSDomain.h>
#include <fastdds/rtps/attributes/HistoryAttributes.h>
#include <fastdds/rtps/attributes/ReaderAttributes.h>
#include <fastrtps/attributes/TopicAttributes.h>
#include <fastrtps/qos/ReaderQos.h>

#include "gateway/upstream/dds_link/exit_codes.hpp"
#include "gateway/upstream/dds_process/start_error.hpp"
#include "gateway/upstream/dds_process/steady.hpp"
#include "gateway/upstream/dds_process/to_idl.hpp"

namespace axisgate::dds {
namespace {

namespace fdds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;

/// Samples that wait for one before them that was lost, and memory for a usual one.
constexpr std::int32_t kMostOutOfOrder = 4096;
constexpr std::uint32_t kUsualPayload = 256;

rtps::HistoryAttributes history_attributes() {
  return {rtps::DYNAMIC_REUSABLE_MEMORY_MODE, kUsualPayload, 0, kMostOutOfOrder};
}

rtps::ReaderAttributes reader_attributes(bool exclusive) {
  rtps::ReaderAttributes out;
  out.endpoint.reliabilityKind = rtps::RELIABLE;
  out.endpoint.durabilityKind = rtps::VOLATILE;
  out.endpoint.topicKind = rtps::WITH_KEY;
  out.endpoint.ownershipKind = exclusive ? fdds::EXCLUSIVE_OWNERSHIP_QOS : fdds::SHARED_OWNERSHIP_QOS;
  // DDS-Security finds a topic's rules by this name; a DataReader has it from its topic.
  out.endpoint.properties.properties().emplace_back("topic_name", kCommandTopicName);
  return out;
}

eprosima::fastrtps::ReaderQos announced_qos(bool exclusive) {
  eprosima::fastrtps::ReaderQos out;
  out.m_reliability.kind = fdds::RELIABLE_RELIABILITY_QOS;
  out.m_durability.kind = fdds::VOLATILE_DURABILITY_QOS;
  out.m_ownership.kind = exclusive ? fdds::EXCLUSIVE_OWNERSHIP_QOS : fdds::SHARED_OWNERSHIP_QOS;
  return out;
}

bool stops(std::uint8_t command) {
  constexpr std::uint8_t kDisable = 2, kHalt = 4, kJogEnd = 33;  // schemas/axisgate.idl; 3 is quick_stop
  return (command >= kDisable && command <= kHalt) || command == kJogEnd;
}

}  // namespace

AxisCommandReader::History::History(const CommandIntake& intake)
    : ReaderHistory(history_attributes()), intake_(intake) {}

bool AxisCommandReader::History::received_change(rtps::CacheChange_t* change, std::size_t missing) {
  return intake_.has_room() && ReaderHistory::received_change(change, missing);
}

AxisCommandReader::AxisCommandReader(RtpsParticipant& participant, CommandTopic topic, CommandIntake& intake,
                                     WriterWatch& watch, Wake& wake)
    : exclusive_(topic == CommandTopic::command), intake_(intake), watch_(watch), wake_(wake), history_(intake) {
  rtps::ReaderAttributes attributes = reader_attributes(exclusive_);
  reader_ = rtps::RTPSDomain::createRTPSReader(&*participant, attributes, &history_, this);
  eprosima::fastrtps::TopicAttributes described(kCommandTopicName, type_.getName(), rtps::WITH_KEY);
  described.auto_fill_type_object = false;
  described.auto_fill_type_information = false;
  if (reader_ == nullptr || !(*participant).registerReader(reader_, described, announced_qos(exclusive_)))
    throw StartError(kExitParticipant, "the reader of topic axisgate/axis_command cannot be made");
}

AxisCommandReader::~AxisCommandReader() {
  if (reader_ != nullptr) rtps::RTPSDomain::removeRTPSReader(reader_);
}

void AxisCommandReader::onReaderMatched(rtps::RTPSReader*, rtps::MatchingInfo& info) {
  const Guid writer = to_guid(info.remoteEndpointGuid);
  if (info.status == rtps::MATCHED_MATCHING) {
    watch_.on_matched(writer, steady_now());
  } else {
    watch_.on_unmatched(writer);
  }
  wake_.set();
}

void AxisCommandReader::onNewCacheChangeAdded(rtps::RTPSReader*, const rtps::CacheChange_t* change) {
  AxisCommand sample;
  // The library reads from its buffer with a pointer that may write, and removes what it has given us as const.
  auto* const mine = const_cast<rtps::CacheChange_t*>(change);
  if (change->kind == rtps::ALIVE && type_.deserialize(&mine->serializedPayload, &sample)) {
    const Guid writer = to_guid(change->writerGUID);
    watch_.on_sample(writer, steady_now());
    const auto strength = static_cast<std::int32_t>(change->reader_info.writer_ownership_strength);
    intake_.add(to_record(sample, {writer, exclusive_ ? strength : 0, to_steady(change->sourceTimestamp.to_ns())}),
                stops(sample.command()));
  }
  history_.remove_change(mine);
  wake_.set();
}

}  // namespace axisgate::dds
