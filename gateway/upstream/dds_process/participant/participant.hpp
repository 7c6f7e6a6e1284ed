// SPDX-License-Identifier: Apache-2.0
// The DDS participant and what is made under it: topics, writers and readers, their QoS ours or the QoS file's.
// Promises that no packet leaves by an interface that was not named, and a StartError that says what could not be made.
// Never knows what is published.
#pragma once

#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantListener.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/DataWriterListener.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>
#include <string>

#include "gateway/upstream/dds_process/participant/participant_options.hpp"

namespace axisgate::dds {

namespace fastdds = eprosima::fastdds::dds;

class Participant {
 public:
  /// The listener may be null; it hears of discovery only.
  Participant(const ParticipantOptions& options, fastdds::DomainParticipantListener* listener);
  ~Participant();
  Participant(const Participant&) = delete;
  Participant& operator=(const Participant&) = delete;

  /// `name` as in the QoS file, without "axisgate_". `user_data`: what others read of it when they discover it.
  [[nodiscard]] fastdds::DataWriter& make_writer(const std::string& topic, const std::string& name,
                                                 fastdds::TypeSupport type, fastdds::DataWriterQos qos,
                                                 const std::vector<std::uint8_t>& user_data = {},
                                                 fastdds::DataWriterListener* listener = nullptr);
  [[nodiscard]] fastdds::DataReader& make_reader(const std::string& topic, fastdds::TypeSupport type,
                                                 const fastdds::DataReaderQos& qos,
                                                 fastdds::DataReaderListener* listener);
  void end_reader(fastdds::DataReader& reader);
  [[nodiscard]] const fastdds::DomainParticipantQos& qos() const { return participant_->get_qos(); }
  /// That of the QoS file where it has one of this name, else the one given.
  [[nodiscard]] fastdds::DataReaderQos reader_qos_of(const std::string& name, fastdds::DataReaderQos qos) const;

 private:
  fastdds::Topic* find_or_make_topic(const std::string& topic, fastdds::TypeSupport type);
  [[nodiscard]] bool in_qos_file(const std::string& profile) const;

  std::string qos_text_;
  fastdds::DomainParticipant* participant_ = nullptr;
  fastdds::Publisher* publisher_ = nullptr;
  fastdds::Subscriber* subscriber_ = nullptr;
};

}  // namespace axisgate::dds
