# SPDX-License-Identifier: Apache-2.0
"""Tables of the manual, printed from the files that are used: drive profiles, panels' tag lists and the PLC's function blocks."""
import csv
import json
import re


def merged(base, mine):
    """As the gateway does it: objects are merged, lists and values replaced, null takes out."""
    made = dict(base)
    for key, value in mine.items():
        if value is None:
            made.pop(key, None)
        elif isinstance(value, dict) and isinstance(made.get(key), dict):
            made[key] = merged(made[key], value)
        else:
            made[key] = value
    return made


def profile(root, name):
    mine = json.loads((root / f"schemas/drives/{name}.json").read_text(encoding="utf-8"))
    return merged(profile(root, mine["extends"]), mine) if "extends" in mine else mine


def plain(text):
    """Without the marks by which the profiles name their sources, and fit for a cell."""
    text = "; ".join(text) if isinstance(text, list) else text
    text = re.sub(r" \((?:[KC]\d+(?:, )?)+\)", "", text)
    return text.replace("|", "\\|").strip()


def table(head, rows):
    lines = [head, ["---"] * len(head), *rows]
    return "\n".join(f"| {' | '.join(map(str, line))} |" for line in lines)


def place(where):
    """An address as the drive's maker writes it."""
    if where == "value":  # of the frame that carries the whole desired state
        return "control frame"
    if not isinstance(where, dict):
        return str(where)
    if "address" in where:
        return place(where["address"])
    if "query" in where:
        return f"query {where['query']}"
    if "heartbeat" in where:
        return "heartbeat"
    if "value" in where or "on" in where:
        return "control frame"
    if set(where) <= {"A", "B"}:
        return ", ".join(place(where[motor]) for motor in sorted(where))
    raise ValueError(f"nobody knows how to print {where}")


def objects_of(drive):
    objects = dict(drive["objects"])
    for name, made in drive.get("each_axis", {}).get("objects", {}).items():
        objects[name.replace("$AXIS.", "")] = made
    for name, made in drive["objects"].items():
        match = re.fullmatch(r"(\$?each)_(\w+)", name, re.IGNORECASE)
        if match:
            objects[match[2]] = made
    return objects


def objects_named(quantity):
    if "bits" in quantity:
        return list(dict.fromkeys(bits["object"] for bits in quantity["bits"])), True
    found = quantity["object"]
    return (found if isinstance(found, list) else [found]), False


def quantities(drive):
    objects, protocols = objects_of(drive), list(drive["protocols"])

    def places(name):
        """Of a part, those of the whole."""
        made = objects.get(name, {})
        return places(made["part"]["of"]) if "part" in made else made.get("at", {})

    def at(quantity, protocol):
        names, all_of_them = objects_named(quantity)
        found = [place(places(name)[protocol]) for name in names if protocol in places(name)]
        return ", ".join(dict.fromkeys(found if all_of_them else found[:1])) or ""

    rows = [[name, *(at(quantity, protocol) for protocol in protocols)] for name, quantity in drive["quantities"].items()]
    return table(["quantity", *protocols], [row for row in rows if any(row[1:])])


def protocols_of(drive):
    rows = []
    for name, protocol in drive["protocols"].items():
        loss = protocol.get("loss")
        guard = protocol.get("guard", {})
        after = loss and loss.get("after_ms", guard.get("time_ms", 0) * guard.get("life_factor", 0))
        after = f" after {after} ms" if after else ""
        way = {"heartbeat_consumer": "it notices{} that the gateway's heartbeat is missing",
               "life_guarding": "it notices{} that nobody guards it", "command_watchdog": "it takes the torque away{} without a command"}
        ends = f"{way[loss['by']].format(after)}: {plain(loss['text'])}" if loss else "**nothing: it goes on**"
        rows.append([f"`{name}`", ends, plain(protocol.get("text", ""))])
    return table(["adapter", "what it does when the gateway dies", "notes"], rows)


def constants(drive):
    rows = []
    each = drive.get("each_axis", {}).get("constants", {})
    for name, constant in {**drive.get("constants", {}), **each}.items():
        motors = [("a", "A"), ("b", "B")] if "$axis" in name else [(None, None)]
        for small, large in motors:
            text = constant.get("text", "")
            text = text[large] if isinstance(text, dict) else text.replace("$AXIS", str(large))
            default = constant.get("default", "read from the drive" if "first" in constant else "none")
            rows.append([name.replace("$axis", str(small)), constant.get("unit", ""), default, plain(text)])
    return table(["constant", "unit", "default", "what it is"], rows)


def checks(drive):
    rows = []
    for check in drive.get("checks", []):
        each = check.get("each", [""])
        remedy = "; ".join(plain(write["why"]) for write in check.get("remedy", []))
        names = " to ".join(f"`{check['name'].replace('$each', one)}`" for one in dict.fromkeys((each[0], each[-1])))
        said = [text.replace("$EACH", "the input") for text in (plain(check["text"]), remedy)]
        rows.append([names, said[0], said[1] or "nothing: it is set by hand"])
    return table(["check", "when it is bad", "what `commission` writes after a yes"], rows)


def setup(drive):
    rows = [[step["write"], step["value"], ", ".join(step.get("on", drive["protocols"])), plain(step["why"])] for step in drive.get("setup", [])]
    return table(["object", "value", "on", "why"], rows) if rows else "Nothing."


def faults(drive):
    alarms = drive["alarms"]
    rows = []
    for row in sorted(alarms.get("rows", []), key=lambda row: row.get("bit", row.get("value", 0))):
        number = f"bit {row['bit']}" if "bit" in row else row.get("value", row.get("mask", ""))
        rows.append([number, row.get("code", ""), plain(row["text"]), plain(row.get("remedy", alarms.get("remedy", "")))])
    for code, text in alarms.get("codes", {}).items():
        rows.append(["", code, plain(text), plain(alarms.get("remedy", ""))])
    return table(["in the drive's word", "error_code", "meaning", "remedy"], rows)


def homing(drive):
    methods = drive.get("homing", {}).get("methods")
    if not methods:
        return "None: this drive has no homing, and `home` is refused (0x02)."
    return f"`homing_method`: {', '.join(str(method) for method in methods)}."


def tags(root, name):
    with open(root / f"deploy/examples/panels/{name}.csv", encoding="utf-8") as file:
        head, *rows = list(csv.reader(file))
    return table(head, rows)


def declared(text, section):
    """Names and types of a block's VAR_INPUT, say."""
    made = re.search(rf"^{section}\n(.*?)^END_VAR$", text, re.DOTALL | re.MULTILINE)
    return re.findall(r"^  (\w+) : (\w+)", made[1], re.MULTILINE) if made else []


def blocks(root, name):
    """Those that a program calls: AXG_Cycle, and all behind the ones that they are made of."""
    text = (root / f"deploy/plc/{name}.st").read_text(encoding="utf-8")
    first, rest = text.split("(* --- What the blocks are made of ")
    found = re.findall(r"^FUNCTION_BLOCK (\w+)\n(.*?)^END_FUNCTION_BLOCK$", first + rest.split("(* --- The blocks ")[1], re.DOTALL | re.MULTILINE)
    columns = [[", ".join(f"{each} {kind}" for each, kind in declared(body, section)) for section in ("VAR_INPUT", "VAR_OUTPUT")] for _, body in found]
    return table(["block", "inputs", "outputs"], [[block, *column] for (block, _), column in zip(found, columns)])


def errors(root, _):
    """ErrorID of the blocks: those that are words of their own, as docs/troubleshooting.md has them, behind rows and results."""
    page = (root / "docs/troubleshooting.md").read_text(encoding="utf-8")
    sections = dict(re.findall(r"^## (\w[\w ]*): [^\n]*\n\n[^\n]*\n[^\n]*\n(.*?)(?=\n\n|\Z)", page, re.DOTALL | re.MULTILINE))
    own, results = ([[cell.strip() for cell in line.strip("| ").split(" |")] for line in sections[name].strip().splitlines()] for name in ("ErrorID", "result"))
    last = max(int(number) for number, name, *_ in results if "(DDS)" not in name)
    rows = [[f"16#0003 to 16#{last:04X}", "result", "the result in register 25: `axisgate explain 16#0009` says more of result 9", "", "7: another client owns the axis; 9: not enabled, faulted or stop-latched"]]
    for number, name, meaning, causes, remedy in own:
        rows.append(["16#0101 to 16#01FF" if number == "16#0100" else number, name, meaning, causes, remedy])
    return table(["ErrorID", "what", "meaning", "usual causes", "what to do"], rows)


PRINTED = {"quantities": quantities, "protocols": protocols_of, "constants": constants, "checks": checks, "setup": setup,
           "faults": faults, "homing": homing}


def printed(root, what):
    """The text of `<!-- printed: what -->`: "checks of kinco-jd", or "tags of coils"."""
    kind, _, name = what.partition(" of ")
    of_files = {"tags": tags, "blocks": blocks, "errors": errors}
    return of_files[kind](root, name) if kind in of_files else PRINTED[kind](profile(root, name))
