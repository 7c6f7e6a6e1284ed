// SPDX-License-Identifier: Apache-2.0
// The link against a slave that is libmodbus itself, in a thread of its own.
#include <modbus/modbus.h>

#include <atomic>
#include <thread>

#include "tests/unit/modbus_rtu/libmodbus_link_stage.hpp"

namespace axisgate::test {
namespace {

class LibmodbusSlave {
 public:
  LibmodbusSlave(int descriptor, int unit)
      : modbus_(modbus_new_rtu("pty", 19200, 'N', 8, 1)), registers_(modbus_mapping_new(0, 0, 200, 0)) {
    modbus_set_socket(modbus_, descriptor);
    modbus_set_slave(modbus_, unit);
    modbus_set_indication_timeout(modbus_, 0, 10'000);
    for (int i = 0; i < 200; ++i) registers_->tab_registers[i] = static_cast<std::uint16_t>(1000 + i);
    thread_ = std::thread([this] { serve(); });
  }
  LibmodbusSlave(const LibmodbusSlave&) = delete;
  LibmodbusSlave& operator=(const LibmodbusSlave&) = delete;
  ~LibmodbusSlave() {
    over_ = true;
    thread_.join();
    modbus_mapping_free(registers_);
    modbus_free(modbus_);
  }

 private:
  void serve() {
    std::array<std::uint8_t, MODBUS_RTU_MAX_ADU_LENGTH> request{};
    while (!over_) {
      const int size = modbus_receive(modbus_, request.data());
      if (size > 0) modbus_reply(modbus_, request.data(), size, registers_);
    }
  }
  modbus_t* modbus_;
  modbus_mapping_t* registers_;
  std::atomic<bool> over_ = false;
  std::thread thread_;
};

class LibmodbusSlaveTest : public LibmodbusLinkStage {
 protected:
  void SetUp() override { open_at(pty.device()); }
  bus::ExchangeResult exchange(const bus::Exchange& exchange) {
    const modbus_rtu::Frame request = modbus_rtu::request_of(exchange, stepper_node(17));
    const std::size_t before = diary.frames.size();
    link->transmit(before + 1, request);
    EXPECT_TRUE(await([&] { return diary.frames.size() > before; }));
    const std::string& told = diary.frames.back();
    const auto judgement = modbus_rtu::judge(from_hex(told.substr(told.find(' ') + 1)), exchange, stepper_node(17));
    EXPECT_TRUE(std::holds_alternative<bus::ExchangeResult>(judgement)) << verdict(judgement);
    return std::get<bus::ExchangeResult>(judgement);
  }
  Pty pty;
  LibmodbusSlave slave{pty.master(), 17};
};

TEST_F(LibmodbusSlaveTest, is_read_and_written_in_all_three_functions) {
  EXPECT_EQ(exchange(read_of(100, 2, 17)), value_of(100, 2, 1100));
  EXPECT_EQ(exchange(write_of(100, 0xBEEF, 2, 17)), bus::ExchangeResult{});
  EXPECT_EQ(exchange(write_of(102, 0x12345678, 4, 17)), bus::ExchangeResult{});
  EXPECT_EQ(exchange(block_of(100, 2, {{102, 4}, {110, 2}}, 17)),
            values({{{100, 0}, 2, 0xBEEF}, {{102, 0}, 4, 0x12345678}, {{110, 0}, 2, 1110}}));
  EXPECT_EQ(diary.noise, 0u);
}

TEST_F(LibmodbusSlaveTest, refuses_what_it_does_not_have) {
  EXPECT_EQ(exchange(read_of(200, 2, 17)), refusal_of(2));
  EXPECT_EQ(exchange(write_of(199, 1, 4, 17)), refusal_of(2));
}

TEST_F(LibmodbusSlaveTest, answers_two_thousand_reads_in_a_row_rightly) {
  for (std::uint16_t i = 0; i < 2000; ++i) {
    const auto at = static_cast<std::uint16_t>(i % 200);
    ASSERT_EQ(exchange(read_of(at, 2, 17)), value_of(at, 2, 1000U + at));
  }
  EXPECT_EQ(diary.noise, 0u);
}

}  // namespace
}  // namespace axisgate::test
