# SPDX-License-Identifier: Apache-2.0
"""What PLCopen Motion Control part 1 says of the outputs of a block and of the states of an axis, asked after each cycle of a program.
Knows the blocks by their outputs alone."""

ENDS = ("Done", "CommandAborted", "Error")
MOTIONS = ("Home", "MoveAbsolute", "MoveRelative", "MoveVelocity", "MoveOther", "Jog", "Halt", "Stop")
SERVICES = ("Reset", "SetPosition", "TakeOver")
STATES = ("ErrorStop", "Disabled", "Stopping", "Homing", "Standstill", "DiscreteMotion", "ContinuousMotion")
MOTION_ACTIVE = 1
STOP_LATCHED = 1 << 7
MOVING = {"Homing", "DiscreteMotion", "ContinuousMotion"}


def outputs(block):
    return {name: getattr(block, name) for name in ("Done", "Busy", "Active", "CommandAborted", "Error", "InVelocity") if hasattr(block, name)}


class BlockRules:
    """One block from cycle to cycle."""

    def __init__(self, name, block):
        self.name, self.block = name, block
        self.asked, self.before = False, {}

    def execute(self):
        return self.block.JogForward or self.block.JogBackward if self.name == "Jog" else self.block.Execute

    def broken(self):
        """The sentences that do not hold in this cycle."""
        now, before, asked = outputs(self.block), self.before, self.execute()
        on = {name for name, value in now.items() if value}
        rises = asked and not self.asked
        if len(on & {"Busy", *ENDS}) > 1:
            yield f"one of Busy, Done, CommandAborted and Error at a time: {on}"
        if len(on & {"Active", *ENDS}) > 1 or ("Active" in on and "Busy" not in on):
            yield f"Active goes with Busy alone: {on}"
        if asked and not on & {"Busy", *ENDS} and not (self.name == "Jog" and self.block.JogForward and self.block.JogBackward):
            yield "while it is asked for one of the outputs is TRUE"
        if now["Error"] != (self.block.ErrorID != 0):
            yield f"ErrorID tells of Error and of nothing else: {now['Error']}, {self.block.ErrorID:#x}"
        if before.get("Busy") and not rises and not on & {"Busy", *ENDS}:
            yield "how it ended is told for a cycle at least"
        if self.name != "Jog":
            ended = {name for name in ENDS if before.get(name)}
            if ended and asked and self.asked and not ended <= on:
                yield f"{ended} stays while Execute does: {on}"
            if ended and not asked and not self.asked and on & set(ENDS):
                yield f"{ended} goes with Execute: {on}"
        if "InVelocity" in on and "Active" not in on:
            yield "InVelocity is of a motion that is active"
        self.asked, self.before = asked, now


class AxisRules:
    """The blocks that a station has, and the states its axis goes through."""

    def __init__(self, station):
        self.station = station
        self.blocks = [BlockRules(name, getattr(station, name)) for name in (*MOTIONS, *SERVICES) if hasattr(station, name)]
        self.state, self.latched = None, False

    def broken(self):
        for rules in self.blocks:
            for sentence in rules.broken():
                yield f"{rules.name}: {sentence}"
        active = [rules.name for rules in self.blocks if rules.name in MOTIONS and rules.block.Active]
        if len(active) > 1:
            yield f"one motion at a time: {active}"
        yield from self.broken_states(self.station.ReadStatus)
        power = self.station.Power
        if power.Error != (power.ErrorID != 0) or (power.Error and power.Busy):
            yield "Power: ErrorID tells of Error, and Busy goes without"
        if power.Status and self.station.ReadStatus.Disabled:
            yield "Power: Status of an axis that is disabled"

    def broken_states(self, status):
        on = [name for name in STATES if getattr(status, name)]
        if len(on) != (1 if status.Valid else 0) or status.Valid == status.Error:
            yield f"one state while it is valid: {on}"
        state = on[0] if on else None
        # The diagram's arrows: a motion begins at standstill or from another motion; a halt, which state 5 shows too, may be replaced.
        # Where no command's motion is active the gateway tells the state by the speed, which may be from before an enable.
        axis = self.station.Axis
        stands = self.state in ("Disabled", "ErrorStop") or (self.state == "Stopping" and self.latched)
        if state in MOVING and axis.MotionState == MOTION_ACTIVE and stands:
            yield f"from {self.state} to {state}"
        self.state, self.latched = state, bool(axis.Alarms & STOP_LATCHED)
