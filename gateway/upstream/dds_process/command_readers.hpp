// The DataReaders of axis_command and object_request, and what the library tells of the writers they are matched with.
// Promises that samples stay in the library, which holds their writers back, until they are taken; listeners only note
// and wake. Never judges a sample.
#pragma once

#include <vector>

#include "gateway/upstream/dds_process/participant.hpp"
#include "gateway/upstream/dds_process/wake.hpp"
#include "gateway/upstream/dds_process/writer_watch.hpp"

namespace axisgate::dds {

/// Hears of all writers of the domain; must be there before the participant is, and outlive it.
class WriterDiscovery : public fastdds::DomainParticipantListener {
 public:
  WriterDiscovery(WriterWatch& watch, Wake& wake) : watch_(watch), wake_(wake) {}
  void on_publisher_discovery(fastdds::DomainParticipant* participant,
                              eprosima::fastrtps::rtps::WriterDiscoveryInfo&& info) override;

 private:
  WriterWatch& watch_;
  Wake& wake_;
};

class CommandReaders : private fastdds::DataReaderListener {
 public:
  CommandReaders(Participant& participant, WriterWatch& watch, Wake& wake);
  ~CommandReaders() override;
  CommandReaders(const CommandReaders&) = delete;
  CommandReaders& operator=(const CommandReaders&) = delete;

  /// At most `most` samples, commands first; fewer: there are no more.
  [[nodiscard]] std::vector<Record> take(std::size_t most);
  /// Begins anew with the commands: what the library thinks who owns which axis is forgotten. Take all samples before.
  void forget_owners();

 private:
  void on_data_available(fastdds::DataReader* reader) override;
  void on_subscription_matched(fastdds::DataReader* reader, const fastdds::SubscriptionMatchedStatus& info) override;
  fastdds::DataReader* make(CommandTopic topic);
  template <typename Sample>
  void take_from(fastdds::DataReader& reader, std::size_t most, std::vector<Record>& taken);

  Participant& participant_;
  WriterWatch& watch_;
  Wake& wake_;
  fastdds::DataReader* commands_;
  fastdds::DataReader* objects_;
};

}  // namespace axisgate::dds
