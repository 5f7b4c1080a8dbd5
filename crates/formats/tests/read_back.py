"""Reads drawings that Tracelight wrote with readers that are not ours, and holds each against the JSON of the same drawing.

    read_back.py FOLDER STEM WIDTH_MM

FOLDER holds STEM.json, .svg, .dxf, .gcode, .hpgl, .ild and .csv, written with `strokes --width`. Readers: svgelements,
ezdxf (its audit, its paths, its HPGL interpreter), gcodeparser. No reader of ILDA is to be had from the package index;
the one here is made from the ILDA Image Data Transfer Format Specification, revision 011, and shares no code with the
writer.

For each file: as many strokes as there are, in their order, each with its length, its bounding box, its start and end,
light on it and dark between; layers and colours where the format has them. The first difference ends the run.
"""

import csv
import json
import math
import re
import struct
import sys
from pathlib import Path


def check(holds, message):
    if not holds:
        sys.exit(f"read_back: {message}")


# --- the truth: the JSON's paths, in millimetres, y up, the origin at the sheet's lower left corner ----------------


def truth(path, width_mm):
    document = json.loads(path.read_text())
    scale = width_mm / document["width_px"]
    height = document["height_px"] * scale
    strokes = []
    for stroke in document["strokes"]:
        points = dense(stroke["path"])
        points = [(x * scale, height - y * scale) for x, y in points]
        if stroke["closed"] and math.dist(points[-1], points[0]) > 1e-6:
            points.append(points[0])
        strokes.append({"points": points, "layer": stroke.get("layer"), "colour": stroke.get("colour")})
    return strokes, (width_mm, height)


def dense(path, steps=2000):
    at, points = path["start"], [path["start"]]
    for element in path["elements"]:
        if "line" in element:
            points.append(element["line"])
        elif "arc" in element:
            (cx, cy), sweep = element["arc"]["centre"], element["arc"]["sweep_rad"]
            dx, dy = at[0] - cx, at[1] - cy
            for i in range(1, steps + 1):
                c, s = math.cos(sweep * i / steps), math.sin(sweep * i / steps)
                points.append((cx + c * dx - s * dy, cy + s * dx + c * dy))
        else:
            points += bezier([at, *element["cubic"]], steps)
        at = points[-1]
    return points


def bezier(control, steps):
    (a, b), (c, d), (e, f), (g, h) = control
    weights = [((1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t * t * (1 - t), t**3) for t in (i / steps for i in range(1, steps + 1))]
    return [(a * p + c * q + e * r + g * s, b * p + d * q + f * r + h * s) for p, q, r, s in weights]


def length(points):
    return sum(math.dist(p, q) for p, q in zip(points, points[1:]))


def box(points):
    xs, ys = [p[0] for p in points], [p[1] for p in points]
    return min(xs), min(ys), max(xs), max(ys)


# --- comparison ---------------------------------------------------------------------------------------------------


def compare(kind, strokes, found, near_mm, length_share=1e-3, starts=True):
    """Strokes of the truth against polylines that were found, one for one."""
    check(len(found) == len(strokes), f"{kind}: {len(found)} strokes instead of {len(strokes)}")
    for number, (stroke, points) in enumerate(zip(strokes, found)):
        wanted = stroke["points"]
        a, b = length(points), length(wanted)
        slack = length_share * b + 4 * near_mm
        check(abs(a - b) <= slack, f"{kind}, stroke {number}: {a:.4f} mm long instead of {b:.4f}")
        off = max(abs(p - q) for p, q in zip(box(points), box(wanted)))
        check(off <= near_mm, f"{kind}, stroke {number}: bounds off by {off:.4f} mm: {box(points)}, {box(wanted)}")
        if starts:
            off = max(math.dist(points[0], wanted[0]), math.dist(points[-1], wanted[-1]))
            check(off <= near_mm, f"{kind}, stroke {number}: begins or ends {off:.4f} mm off")
    print(f"{kind}: {len(found)} strokes, {sum(map(length, found)):.2f} mm, in order")


def chains(kind, strokes, pieces, near_mm):
    """Pieces in order, put together to strokes: each takes as many as make its length."""
    found, left = [], list(pieces)
    for number, stroke in enumerate(strokes):
        wanted, points = length(stroke["points"]), []
        while left and (not points or length(points) < wanted * 0.999 - 4 * near_mm):
            piece = left.pop(0)
            gap = math.dist(points[-1], piece[0]) if points else 0.0
            check(gap <= near_mm, f"{kind}, stroke {number}: a gap of {gap:.4f} mm")
            points += piece
        # what adds nothing: a pen put down where it is
        while left and length(left[0]) <= near_mm and points and math.dist(points[-1], left[0][0]) <= near_mm:
            points += left.pop(0)
        check(points, f"{kind}: nothing left for stroke {number}")
        found.append(points)
    check(not left, f"{kind}: {len(left)} pieces too many")
    return found


# --- readers ------------------------------------------------------------------------------------------------------


def read_svg(path, strokes, size):
    import svgelements

    # at 25.4 dots an inch a millimetre is a dot
    svg = svgelements.SVG.parse(str(path), reify=True, ppi=25.4)
    check(abs(svg.width - size[0]) < 1e-3 and abs(svg.height - size[1]) < 1e-3, f"SVG: {svg.width} × {svg.height}")
    found = []
    for element in svg.elements():
        if not isinstance(element, svgelements.Path):
            continue
        stroke = strokes[len(found)] if len(found) < len(strokes) else {}
        if stroke.get("colour"):
            check(element.stroke.hex == stroke["colour"], f"SVG: {element.stroke.hex} instead of {stroke['colour']}")
        points = [element.first_point]
        for segment in element:
            curved = not isinstance(segment, (svgelements.Move, svgelements.Line, svgelements.Close))
            if not isinstance(segment, svgelements.Move):
                points += [segment.point(i / 500) for i in range(1, 501)] if curved else [segment.end]
        found.append([(p.x, size[1] - p.y) for p in points])
    compare("SVG by svgelements", strokes, found, 2e-3)
    inkscape = "{http://www.inkscape.org/namespaces/inkscape}"
    import xml.etree.ElementTree as ElementTree

    layers = []
    for group in ElementTree.parse(path).iter("{http://www.w3.org/2000/svg}g"):
        if group.get(inkscape + "groupmode") == "layer":
            layers += [group.get(inkscape + "label")] * len(group.findall("{http://www.w3.org/2000/svg}path"))
    wanted = [s["layer"] for s in strokes if s["layer"]]
    check(layers == wanted, f"SVG: layers {layers} instead of {wanted}")


def read_dxf(path, strokes, size):
    import ezdxf
    from ezdxf.path import make_path

    document = ezdxf.readfile(path)
    audit = document.audit()
    check(not audit.errors and not audit.fixes, f"DXF: {[e.message for e in audit.errors + audit.fixes]}")
    check(document.header["$INSUNITS"] == 4, "DXF: not in millimetres")
    pieces, looks, low, high = [], [], document.header["$EXTMIN"], document.header["$EXTMAX"]
    for entity in document.modelspace():
        curve = make_path(entity)
        pieces.append([(p.x, p.y) for p in curve.flattening(1e-4, segments=64)])
        rgb = entity.rgb or ezdxf.colors.aci2rgb(entity.dxf.color if entity.dxf.color < 256 else 7)
        looks.append((entity.dxf.layer, "#%02x%02x%02x" % tuple(rgb), pieces[-1]))
    found = chains("DXF by ezdxf", strokes, pieces, 1e-3)
    # a circle has no beginning
    compare("DXF by ezdxf", strokes, found, 2e-3, starts=not any(e.dxftype() == "CIRCLE" for e in document.modelspace()))
    bounds = box([p for points in found for p in points])
    check(max(abs(a - b) for a, b in zip(bounds, (low[0], low[1], high[0], high[1]))) < 2e-3, f"DXF: extents {low} {high}")
    index = 0
    for stroke, points in zip(strokes, found):
        layer, colour, _ = looks[index]
        check(layer == re.sub(r'[<>/\\":;?*|=`,]', "_", stroke["layer"] or "0"), f"DXF: layer {layer} instead of {stroke['layer']}")
        # colour 7 is black on paper and white on the screen
        if stroke["colour"] not in (None, "#000000"):
            check(colour == stroke["colour"], f"DXF: {colour} instead of {stroke['colour']}")
        taken = 0
        while index < len(looks) and taken < len(points):
            taken += len(looks[index][2])
            index += 1


def read_gcode(path, strokes, size):
    from gcodeparser import parse_gcode_lines

    text = path.read_text()
    at, lit, power, found = (0.0, 0.0), False, 0, []
    for line in parse_gcode_lines(text):
        letter, number = line.command
        power = line.params.get("S", power)
        if letter == "M":
            check(number in (2, 3, 4, 5), f"G-code: M{number}")
            lit = number in (3, 4)
        if letter != "G" or number > 3:
            continue
        to = (line.params["X"], line.params["Y"])
        check(min(to) >= -1e-9, f"G-code: {to} is off the sheet")
        if number == 0:
            check(line.params.get("S") == 0, "G-code: a dark move without S0")
            if lit:
                found.append([to])
        else:
            check(lit and power > 0, "G-code: a line that is not lit")
            found[-1] += [to] if number == 1 else gcode_arc(at, to, line.params, number == 3)
        at = to
    check(not lit, "G-code: the laser is left on")
    check(text.index("M5") < text.index("M4"), "G-code: the laser is not switched off first")
    compare("G-code by gcodeparser", strokes, found, 0.015)


def gcode_arc(at, to, params, anticlockwise, steps=500):
    cx, cy = at[0] + params["I"], at[1] + params["J"]
    radius, end = math.dist(at, (cx, cy)), math.dist(to, (cx, cy))
    check(abs(radius - end) < 0.002, f"G-code: an arc whose ends are {radius} and {end} from its centre")
    first, last = math.atan2(at[1] - cy, at[0] - cx), math.atan2(to[1] - cy, to[0] - cx)
    sweep = (last - first) % math.tau if anticlockwise else -((first - last) % math.tau)
    angles = [first + sweep * i / steps for i in range(1, steps + 1)]
    return [(cx + radius * math.cos(a), cy + radius * math.sin(a)) for a in angles]


def read_hpgl(path, strokes, size):
    from ezdxf.addons.hpgl2.backend import Backend
    from ezdxf.addons.hpgl2.interpreter import Interpreter
    from ezdxf.addons.hpgl2.plotter import Plotter
    from ezdxf.addons.hpgl2.tokenizer import hpgl2_commands

    pieces = []

    class Collector(Backend):
        def draw_polyline(self, properties, points):
            points = [(p.x / 40, p.y / 40) for p in points]
            if len(points) > 1:
                pieces.append(points)

        def draw_paths(self, properties, paths, filled):
            check(False, "HPGL: paths where there are none")

    commands = hpgl2_commands(path.read_bytes())
    check(commands, "HPGL: not taken for HPGL")
    interpreter = Interpreter(Plotter(Collector()))
    interpreter.run(commands)
    # beginning anew changes nothing of a plotter that just begins
    unknown = interpreter.not_implemented_commands - {"IN", "DF"}
    check(not interpreter.errors and not unknown, f"HPGL: {interpreter.errors} {unknown}")
    found = chains("HPGL by ezdxf", strokes, pieces, 0.06)
    compare("HPGL by ezdxf", strokes, found, 0.06, length_share=4e-3)


def read_ilda(path, strokes, size):
    data, at, frames = path.read_bytes(), 0, []
    while True:
        check(len(data) >= at + 32, "ILDA: no empty header at the end")
        magic, kind, count, number, total = struct.unpack(">4s3xB16xHHH2x", data[at : at + 32])
        at += 32
        check(magic == b"ILDA" and kind == 5, f"ILDA: a header of {magic}, format {kind}")
        if count == 0:
            break
        check(number == len(frames) and number < total, f"ILDA: frame {number} of {total}")
        frames.append([struct.unpack(">hhBBBB", data[at + 8 * i : at + 8 * i + 8]) for i in range(count)])
        at += 8 * count
    check(at == len(data), f"ILDA: {len(data) - at} bytes after the end")
    found, lit, last, dark_jump = [], False, None, 0.0
    scale = max(size) / 65534
    for frame in frames:
        check([bool(p[2] & 0x80) for p in frame] == [False] * (len(frame) - 1) + [True], "ILDA: last point not marked")
        for x, y, status, blue, green, red in frame:
            point = (x * scale + size[0] / 2, y * scale + size[1] / 2)
            is_lit = not status & 0x40
            check(not is_lit or max(red, green, blue) > 0, "ILDA: lit points without light")
            if is_lit and not lit:
                check(last == point, "ILDA: the light comes on in motion")
                found.append([])
                colour = strokes[len(found) - 1]["colour"] if len(found) <= len(strokes) else None
                shown = "#%02x%02x%02x" % (red, green, blue)
                check(colour in (None, "#000000", shown), f"ILDA: {shown} instead of {colour}")
            if lit and not is_lit:
                check(last == point, "ILDA: the light goes off in motion")
            if is_lit:
                found[-1].append(point)
            lit, last = is_lit, point
    check(not lit, "ILDA: the light is left on")
    compare("ILDA by the specification", strokes, found, max(size) * 7e-4, length_share=1e-2)


def read_csv(path, strokes, size):
    found = {}
    with open(path, newline="") as file:
        for row in csv.DictReader(file):
            point = (float(row["x_m"]) * 1e3 + size[0] / 2, float(row["y_m"]) * 1e3 + size[1] / 2)
            found.setdefault(row["stroke"], []).append(point)
    compare("CSV by Python", strokes, list(found.values()), 0.015)


def main():
    folder, stem, width = Path(sys.argv[1]), sys.argv[2], float(sys.argv[3])
    strokes, size = truth(folder / f"{stem}.json", width)
    check(strokes, "the JSON has no strokes")
    print(f"{stem}: {len(strokes)} strokes on {size[0]:.1f} × {size[1]:.1f} mm")
    readers = {"svg": read_svg, "dxf": read_dxf, "gcode": read_gcode, "hpgl": read_hpgl, "ild": read_ilda, "csv": read_csv}
    for extension, reader in readers.items():
        reader(folder / f"{stem}.{extension}", strokes, size)


if __name__ == "__main__":
    main()
