# SPDX-License-Identifier: Apache-2.0
"""A Modbus RTU slave that nobody here wrote: libmodbus's own server, with the registers that an iD286pro has.

Run as: libmodbus_slave.py DEVICE UNIT. It prints "ready", and each request it was sent.
"""
import ctypes
import sys

FIRST, LAST = 100, 430  # one mapping from the first to the last register
NO_PARITY, BAUD, REQUEST_BYTES = b"N", 19200, 260
WRITE_ONE = 0x06
INPUT_VOLTAGE, MICROSTEP_IN_EFFECT, RUN_STATE, POSITION, MICROSTEP, RUN_MODE, TARGET, CONTROL = 101, 104, 109, 117, 242, 296, 313, 323
AS_DELIVERED = {INPUT_VOLTAGE: 3610, MICROSTEP_IN_EFFECT: 10000, RUN_STATE: 2, MICROSTEP: 10000, RUN_MODE: 1, 303: 500, 304: 500,
                306: 1000, 307: 1000, 317: 0x9400, 318: 0x7735, 319: 0x6C00, 320: 0x88CA}
MOVE_ABSOLUTE = 1


class Mapping(ctypes.Structure):
    _fields_ = [*[(name, ctypes.c_int) for name in ("nb_bits", "start_bits", "nb_input_bits", "start_input_bits", "nb_input_registers",
                                                    "start_input_registers", "nb_registers", "start_registers")],
                ("tab_bits", ctypes.c_void_p), ("tab_input_bits", ctypes.c_void_p), ("tab_input_registers", ctypes.c_void_p),
                ("tab_registers", ctypes.POINTER(ctypes.c_uint16))]


def library():
    modbus = ctypes.CDLL("libmodbus.so.5", use_errno=True)
    modbus.modbus_new_rtu.restype = ctypes.c_void_p
    modbus.modbus_new_rtu.argtypes = [ctypes.c_char_p, ctypes.c_int, ctypes.c_char, ctypes.c_int, ctypes.c_int]
    modbus.modbus_mapping_new_start_address.restype = ctypes.POINTER(Mapping)
    modbus.modbus_mapping_new_start_address.argtypes = [ctypes.c_uint] * 8
    for name, more in (("set_slave", [ctypes.c_int]), ("connect", []), ("receive", [ctypes.c_char_p]),
                       ("reply", [ctypes.c_char_p, ctypes.c_int, ctypes.POINTER(Mapping)])):
        getattr(modbus, f"modbus_{name}").argtypes = [ctypes.c_void_p, *more]
    return modbus


def obey(frame, registers):
    """The little that a map alone cannot do: a move is at its target at once."""
    if frame[1] != WRITE_ONE or frame[2] << 8 | frame[3] != CONTROL:
        return
    if frame[4] << 8 | frame[5] == MOVE_ABSOLUTE:
        for word in (0, 1):
            registers[POSITION - FIRST + word] = registers[TARGET - FIRST + word]


def serve(device, unit):
    modbus = library()
    context = modbus.modbus_new_rtu(device.encode(), BAUD, NO_PARITY, 8, 1)
    mapping = modbus.modbus_mapping_new_start_address(0, 0, 0, 0, FIRST, LAST - FIRST + 1, 0, 0)
    registers = mapping.contents.tab_registers
    for register, value in AS_DELIVERED.items():
        registers[register - FIRST] = value
    modbus.modbus_set_slave(context, unit)
    if modbus.modbus_connect(context) != 0:
        sys.exit(f"{device}: not opened")
    print("ready", flush=True)
    request = ctypes.create_string_buffer(REQUEST_BYTES)
    while True:
        length = modbus.modbus_receive(context, request)
        if length <= 0:
            continue  # for another unit, or a broken frame
        frame = request.raw[:length]
        modbus.modbus_reply(context, request, length, mapping)
        obey(frame, registers)
        print(frame.hex(), flush=True)


if __name__ == "__main__":
    serve(sys.argv[1], int(sys.argv[2]))
