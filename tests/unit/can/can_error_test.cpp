#include "adapters/can/can_error.hpp"

#include <gtest/gtest.h>
#include <linux/can/error.h>

#include <array>
#include <functional>
#include <vector>

namespace axisgate::can {
namespace {

using Data = std::array<Byte, 8>;

TEST(CanError, the_classes_are_those_of_the_kernel) {
  EXPECT_EQ(error_class::kTxTimeout, CAN_ERR_TX_TIMEOUT);
  EXPECT_EQ(error_class::kLostArbitration, CAN_ERR_LOSTARB);
  EXPECT_EQ(error_class::kController, CAN_ERR_CRTL);
  EXPECT_EQ(error_class::kProtocol, CAN_ERR_PROT);
  EXPECT_EQ(error_class::kTransceiver, CAN_ERR_TRX);
  EXPECT_EQ(error_class::kNoAck, CAN_ERR_ACK);
  EXPECT_EQ(error_class::kBusOff, CAN_ERR_BUSOFF);
  EXPECT_EQ(error_class::kBusError, CAN_ERR_BUSERROR);
  EXPECT_EQ(error_class::kRestarted, CAN_ERR_RESTARTED);
  EXPECT_EQ(error_class::kCounters, CAN_ERR_CNT);
}

struct Case {
  std::uint32_t classes;
  Data data;
  CanErrors expected;
  std::string words;
};

std::vector<Case> cases() {
  return {
      {CAN_ERR_BUSOFF, {}, {.bus_off = true}, "bus-off"},
      {CAN_ERR_RESTARTED, {}, {.restarted = true}, "restarted after bus-off"},
      {CAN_ERR_ACK, {}, {.no_ack = true}, "no acknowledgement"},
      {CAN_ERR_TX_TIMEOUT, {}, {.transmit_timeout = true}, "transmit timeout"},
      {CAN_ERR_LOSTARB, {7}, {.lost_arbitration = true}, "arbitration lost"},
      {CAN_ERR_TRX, {}, {.transceiver_error = true}, "transceiver error"},
      {CAN_ERR_BUSERROR, {}, {.protocol_error = true}, "protocol error"},
      {CAN_ERR_CNT, {0, 0, 0, 0, 0, 0, 128, 3}, {}, "error of no known class"},
      {CAN_ERR_CRTL, {0, CAN_ERR_CRTL_RX_PASSIVE}, {.error_passive = true}, "error passive"},
      {CAN_ERR_CRTL, {0, CAN_ERR_CRTL_TX_PASSIVE}, {.error_passive = true}, "error passive"},
      {CAN_ERR_CRTL, {0, CAN_ERR_CRTL_RX_WARNING}, {.error_warning = true}, "error warning"},
      {CAN_ERR_CRTL, {0, CAN_ERR_CRTL_TX_WARNING}, {.error_warning = true}, "error warning"},
      {CAN_ERR_CRTL, {0, CAN_ERR_CRTL_ACTIVE}, {.error_active = true}, "error active again"},
      {CAN_ERR_CRTL, {0, CAN_ERR_CRTL_RX_OVERFLOW}, {.receive_overflow = true}, "receive overflow in the controller"},
      {CAN_ERR_CRTL, {0, CAN_ERR_CRTL_TX_OVERFLOW}, {.transmit_overflow = true}, "transmit overflow in the controller"},
      {CAN_ERR_PROT, {0, 0, CAN_ERR_PROT_STUFF, 0}, {.protocol_error = true}, "protocol error"},
      {CAN_ERR_PROT,
       {0, 0, 0, CAN_ERR_PROT_LOC_ACK},
       {.no_ack = true, .protocol_error = true},
       "no acknowledgement, protocol error"},
      {CAN_ERR_CRTL | CAN_ERR_ACK,
       {0, CAN_ERR_CRTL_TX_PASSIVE},
       {.no_ack = true, .error_passive = true},
       "no acknowledgement, error passive"},
  };
}

TEST(CanError, each_class_says_what_it_means) {
  for (const Case& one : cases()) {
    EXPECT_EQ(decode_errors(one.classes, one.data), one.expected) << one.words;
    EXPECT_EQ(text(decode_errors(one.classes, one.data)), one.words);
  }
}

TEST(CanError, data_of_another_class_says_nothing) {
  const Data all_set{0xFF, 0xFF, 0xFF, CAN_ERR_PROT_LOC_ACK, 0xFF, 0xFF, 0xFF, 0xFF};
  EXPECT_EQ(decode_errors(CAN_ERR_BUSOFF, all_set), CanErrors{.bus_off = true});
}

TEST(CanError, missing_data_is_no_news) {
  EXPECT_EQ(decode_errors(CAN_ERR_CRTL, {}), CanErrors{});
  const Data data{0, CAN_ERR_CRTL_TX_PASSIVE};
  EXPECT_EQ(decode_errors(CAN_ERR_CRTL, Bytes(data).first(1)), CanErrors{});
  EXPECT_EQ(decode_errors(CAN_ERR_CRTL, Bytes(data).first(2)), CanErrors{.error_passive = true});
}

}  // namespace
}  // namespace axisgate::can
