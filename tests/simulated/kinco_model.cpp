// SPDX-License-Identifier: Apache-2.0
#include "tests/simulated/kinco_model.hpp"

#include "tests/simulated/jd_objects.hpp"
#include "tests/simulated/md_objects.hpp"

namespace axisgate::simulated {

const KincoModel& jd_model() {
  static const KincoModel model{
      .type = KincoType::jd,
      .name = "jd",
      .motion_objects = jd_motion_objects(),
      .setup_objects = jd_setup_objects(),
      .encoder_counts = 10000,
      .digital_inputs = 8,
      .out_of_range = OutOfRange::clamp,
      .fault_reset_word = 0x0080,
      .speed_reading = SpeedReading::rpm_each_200_ms,
      .has_stop_options = false,
      .has_halt = false,
      .has_error_word_2 = false,
      .remote_bit_in_mode_3 = true,
      .keeps_single_turn_position = false,
      .home_offset_without_move = true,
      .torque_object_is_current = true,
      .rs485_speaks_this_protocol = false,
  };
  return model;
}

const KincoModel& md_model() {
  static const KincoModel model{
      .type = KincoType::md,
      .name = "md",
      .motion_objects = md_motion_objects(),
      .setup_objects = md_setup_objects(),
      .encoder_counts = 65536,
      .digital_inputs = 4,
      .out_of_range = OutOfRange::refuse,
      .fault_reset_word = 0x0086,
      .speed_reading = SpeedReading::dec,
      .has_stop_options = true,
      .has_halt = true,
      .has_error_word_2 = true,
      .remote_bit_in_mode_3 = false,
      .keeps_single_turn_position = true,
      .home_offset_without_move = false,
      .torque_object_is_current = false,
      .rs485_speaks_this_protocol = true,
  };
  return model;
}

const KincoModel& model_of(KincoType type) { return type == KincoType::jd ? jd_model() : md_model(); }

}  // namespace axisgate::simulated
