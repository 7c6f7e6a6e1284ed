# SPDX-License-Identifier: Apache-2.0
"""pymodbus speaks every function code the gateway has, on one connection and on many."""
import socket
import sys
import unittest

from pymodbus.client import ModbusTcpClient
from pymodbus.constants import DeviceInformation
from pymodbus.diag_message import ReturnQueryDataRequest
from pymodbus.mei_message import ReadDeviceInformationRequest
from pymodbus.pdu import ExceptionResponse
from pymodbus.register_read_message import ReadWriteMultipleRegistersRequest
from pymodbus.register_write_message import MaskWriteRegisterRequest

from served import Served

PROGRAM = sys.argv.pop(1)
TARGET_TORQUE = 146
MAX_TORQUE = 147


def signed32(high, low):
    value = high << 16 | low
    return value - (1 << 32) if value >> 31 else value


class Pymodbus(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.served = Served(PROGRAM)

    @classmethod
    def tearDownClass(cls):
        cls.served.stop()

    def setUp(self):
        self.client = ModbusTcpClient("127.0.0.1", port=self.served.port, timeout=20)
        self.assertTrue(self.client.connect())
        self.addCleanup(self.client.close)

    def assert_exception(self, reply, code):
        self.assertIsInstance(reply, ExceptionResponse)
        self.assertEqual(reply.exception_code, code)

    def assert_done(self, reply):
        self.assertFalse(reply.isError(), reply)

    def test_1_reads_coils(self):
        self.assertEqual(len(self.client.read_coils(100, 10, slave=1).bits), 16)

    def test_2_reads_discrete_inputs(self):
        self.assertTrue(self.client.read_discrete_inputs(100, 13, slave=1).bits[0])

    def test_3_and_4_show_the_same_table(self):
        holding = self.client.read_holding_registers(100, 17, slave=1).registers
        inputs = self.client.read_input_registers(100, 17, slave=1).registers
        self.assertEqual(holding, inputs)
        self.assertEqual(signed32(holding[2], holding[3]), 100000)

    def test_3_reads_125_registers_over_several_axes(self):
        registers = self.client.read_holding_registers(200, 125, slave=1).registers
        self.assertEqual(len(registers), 125)
        self.assertEqual(signed32(registers[102], registers[103]), 300000)

    def test_3_reads_the_overview_of_all_axes(self):
        registers = self.client.read_holding_registers(60010, 40, slave=1).registers
        self.assertEqual(signed32(registers[2], registers[3]), 100000)
        self.assertEqual(signed32(registers[12], registers[13]), 200000)

    def test_5_and_15_write_coils(self):
        self.assert_done(self.client.write_coil(100, True, slave=1))
        self.assertTrue(self.client.read_coils(100, 1, slave=1).bits[0])
        self.assert_done(self.client.write_coils(100, [False, False], slave=1))
        self.assertFalse(self.client.read_coils(100, 1, slave=1).bits[0])

    def test_6_writes_a_register(self):
        self.assert_done(self.client.write_register(TARGET_TORQUE, 77, slave=1))
        self.assertEqual(self.client.read_holding_registers(TARGET_TORQUE, 1, slave=1).registers, [77])

    def test_16_writes_a_cyclic_block(self):
        # 146 target_torque, 147 max_torque, 148..153 the profile's three values
        values = [5, 900, 0, 1000, 0, 2000, 0, 3000]
        self.assert_done(self.client.write_registers(TARGET_TORQUE, values, slave=1))
        self.assertEqual(self.client.read_holding_registers(TARGET_TORQUE, 8, slave=1).registers, values)

    def test_22_masks_a_register(self):
        self.assert_done(self.client.write_register(MAX_TORQUE, 0x0125, slave=1))
        reply = self.client.execute(MaskWriteRegisterRequest(MAX_TORQUE, and_mask=0x00F0, or_mask=0x0008, unit=1))
        self.assert_done(reply)
        self.assertEqual(self.client.read_holding_registers(MAX_TORQUE, 1, slave=1).registers, [0x0028])

    def test_23_reads_what_it_has_written(self):
        reply = self.client.execute(ReadWriteMultipleRegistersRequest(
            read_address=TARGET_TORQUE, read_count=2, write_address=TARGET_TORQUE, write_registers=[11, 22], unit=1))
        self.assertEqual(reply.registers, [11, 22])

    def test_8_returns_the_data(self):
        reply = self.client.execute(ReturnQueryDataRequest(0x1234, unit=1))
        self.assertEqual(reply.message, (0x1234,))

    def test_43_14_identifies_the_gateway_on_all_levels(self):
        for level in (DeviceInformation.Basic, DeviceInformation.Regular, DeviceInformation.Extended):
            reply = self.client.execute(ReadDeviceInformationRequest(read_code=level, unit=1))
            self.assert_done(reply)
            self.assertIn(0, reply.information)
            self.assertIn(2, reply.information)
        reply = self.client.execute(ReadDeviceInformationRequest(read_code=DeviceInformation.Specific, object_id=0, unit=1))
        self.assertEqual(list(reply.information), [0])

    def test_exceptions_are_those_of_the_contract(self):
        self.assert_exception(self.client.write_register(102, 1, slave=1), 0x02)
        self.assert_exception(self.client.write_register(142, 1, slave=1), 0x02)
        self.assert_exception(self.client.write_register(154, 999, slave=1), 0x03)
        self.assert_exception(self.client.write_register(246, 1, slave=1), 0x0A)
        self.assert_exception(self.client.write_register(346, 1, slave=1), 0x04)
        self.assert_exception(self.client.write_register(446, 1, slave=1), 0x0B)

    def test_thirty_two_connections_at_once(self):
        clients = [ModbusTcpClient("127.0.0.1", port=self.served.port, timeout=20) for _ in range(32)]
        for client in clients:
            self.assertTrue(client.connect())
            self.addCleanup(client.close)
        for _ in range(5):
            for client in clients:
                registers = client.read_holding_registers(102, 2, slave=1).registers
                self.assertEqual(signed32(*registers), 100000)

    def test_bytes_that_are_no_modbus_end_their_connection_only(self):
        with socket.create_connection(("127.0.0.1", self.served.port), timeout=20) as web:
            web.sendall(b"GET / HTTP/1.1\r\n\r\n")
            try:
                self.assertEqual(web.recv(100), b"")
            except ConnectionResetError:
                pass  # closed as well: it had more to say than was read
        self.assert_done(self.client.read_holding_registers(0, 1, slave=1))


if __name__ == "__main__":
    unittest.main()
