// Process data, cut by a map and built from one.
#include "adapters/canopen/process_data.hpp"

#include "adapters/canopen/cob_id.hpp"
#include "gateway/core/random.hpp"
#include "tests/unit/canopen/canopen_frames.hpp"

namespace axisgate::canopen {
namespace {

using test::from_hex;

const bus::ProcessMap kMap{{{0x6041, 0}, 2}, {{0x6064, 0}, 4}, {{0x6061, 0}, 1}};

TEST(ProcessData, is_cut_in_the_order_of_its_map) {
  const bus::ReplyFields expected{{{0x6041, 0}, 2, 0x0637}, {{0x6064, 0}, 4, 0xFFFFB1E0}, {{0x6061, 0}, 1, 0x08}};
  EXPECT_EQ(decode_process_data(kMap, from_hex("37 06 E0 B1 FF FF 08")), expected);
  EXPECT_EQ(decode_process_data(kMap, from_hex("37 06 E0 B1 FF FF 08 99")), expected) << "the surplus is not looked at";
}

TEST(ProcessData, shorter_than_its_map_gives_no_value_at_all) {
  for (const char* hex : {"", "37", "37 06", "37 06 E0 B1 FF FF"}) {
    EXPECT_FALSE(decode_process_data(kMap, from_hex(hex))) << hex;
  }
}

TEST(ProcessData, of_any_map_that_fits_a_frame_comes_back_as_it_was_sent) {
  Random random(3);
  static constexpr std::array<std::uint8_t, 3> kSizes{1, 2, 4};
  for (int run = 0; run < 2000; ++run) {
    bus::ProcessMap map;
    bus::ReplyFields values;
    for (;;) {
      const std::uint8_t size = kSizes.at(random.below(3));
      if (size_of(map) + size > can::kMaxFrameBytes) break;
      const auto index = static_cast<std::uint16_t>(random.next());
      map.push_back({{index, 0}, size});
      values.push_back({{index, 0}, size, static_cast<std::uint32_t>(random.below(1ULL << (8 * size)))});
    }
    const can::CanFrame frame = encode_process_data(tpdo_id(1, 1), values);
    ASSERT_EQ(decode_process_data(map, frame.bytes()), values);
  }
}

TEST(CobIds, of_the_set_are_told_apart_and_no_other_is_taken) {
  EXPECT_EQ(cob_id(0x000), (CobId{Service::nmt, 0, 0}));
  EXPECT_EQ(cob_id(0x080), (CobId{Service::sync, 0, 0}));
  EXPECT_EQ(cob_id(0x081), (CobId{Service::emergency, 1, 0}));
  EXPECT_EQ(cob_id(0x4FF), (CobId{Service::tpdo, 127, 4}));
  EXPECT_EQ(cob_id(0x57F), (CobId{Service::rpdo, 127, 4}));
  EXPECT_EQ(cob_id(0x601), (CobId{Service::sdo_request, 1, 0}));
  EXPECT_EQ(cob_id(0x701), (CobId{Service::error_control, 1, 0}));
  for (const std::uint32_t id :
       {0x001U, 0x07FU, 0x100U, 0x101U, 0x180U, 0x580U, 0x681U, 0x6FFU, 0x700U, 0x780U, 0x7E4U, 0x7FFU, 0x800U}) {
    EXPECT_FALSE(cob_id(id)) << std::hex << id;
  }
  for (std::uint8_t number = 1; number <= kTpdos; ++number) {
    for (const std::uint8_t node : std::initializer_list<std::uint8_t>{1, 64, 127}) {
      EXPECT_EQ(cob_id(tpdo_id(number, node)), (CobId{Service::tpdo, node, number}));
      EXPECT_EQ(cob_id(rpdo_id(number, node)), (CobId{Service::rpdo, node, number}));
    }
  }
}

TEST(Filters, let_through_what_the_nodes_send_and_nothing_else) {
  const auto filters = filters_for({1, 5});
  const auto passes = [&](std::uint32_t id) {
    return std::ranges::any_of(filters, [&](const can::CanFilter& f) { return f.passes(can::data_frame(id, {})); });
  };
  std::vector<std::uint32_t> passing;
  for (std::uint32_t id = 0; id <= can::kMaxStandardId; ++id) {
    if (passes(id)) passing.push_back(id);
  }
  EXPECT_THAT(passing, testing::ElementsAre(0x081, 0x085, 0x181, 0x185, 0x281, 0x285, 0x381, 0x385, 0x481, 0x485, 0x581,
                                            0x585, 0x701, 0x705));
}

}  // namespace
}  // namespace axisgate::canopen
