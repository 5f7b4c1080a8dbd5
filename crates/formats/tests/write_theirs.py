"""Writes a DXF of everything that is read with a library that is not ours, has Tracelight read it, and compares.

    write_theirs.py FOLDER TRACELIGHT

ezdxf writes the file, takes its blocks apart and measures its paths; `TRACELIGHT strokes --json` must find the same
length on each layer, the same bounds, and each layer's colour.
"""

import json
import math
import subprocess
import sys
from pathlib import Path

import ezdxf
from ezdxf.disassemble import recursive_decompose
from ezdxf.path import make_path
from read_back import dense, length


def check(holds, message):
    if not holds:
        sys.exit(f"write_theirs: {message}")


def drawing(version):
    document = ezdxf.new(version, units=4)
    for number, name in enumerate(["lines", "arcs", "ellipses", "splines", "polylines", "blocks", "mirrored", "nested", "tilted", "fit points"], 1):
        document.layers.add(name, color=number * 11)
    model = document.modelspace()

    def on(layer, **more):
        return {"layer": layer, **more}

    model.add_line((0, 0), (100, 10), dxfattribs=on("lines"))
    model.add_line((0, 50), (70, -35), dxfattribs=on("lines", color=1))
    model.add_arc((50, 50), 20, 30, 200, dxfattribs=on("arcs"))
    model.add_arc((50, 50), 25, 300, 45, dxfattribs=on("arcs"))
    model.add_circle((150, 50), 12, dxfattribs=on("arcs"))
    model.add_arc((50, 50), 30, 10, 80, dxfattribs=on("mirrored", extrusion=(0, 0, -1)))
    model.add_circle((200, 100), 9, dxfattribs=on("tilted", extrusion=(0, 0.6, 0.8)))
    points = [(0, 0, 0.5), (30, 0, -0.3), (30, 30, 0), (0, 30, 1)]
    if version != "R12":
        model.add_ellipse((150, -50), (30, 10), 0.4, 0, math.tau, dxfattribs=on("ellipses"))
        model.add_ellipse((150, -50), (0, 40), 0.5, 0.5, 4, dxfattribs=on("ellipses"))
        model.add_ellipse((90, -50), (20, 5), 0.5, 0.5, 4, dxfattribs=on("ellipses", extrusion=(0, 0, -1)))
        control = [(0, 100), (20, 140), (40, 80), (60, 130), (80, 100), (100, 120)]
        model.add_open_spline(control, 3, dxfattribs=on("splines"))
        model.add_open_spline(control, 5, dxfattribs=on("splines"))
        model.add_rational_spline(control, [1, 2, 3, 0.5, 1, 1], 4, dxfattribs=on("splines"))
        model.add_spline(dxfattribs=on("splines")).set_closed([(x + 120, y, 0) for x, y in control], 3)
        model.add_spline(control, dxfattribs=on("fit points"))
        model.add_lwpolyline(points, format="xyb", close=True, dxfattribs=on("polylines"))
        mirrored = on("mirrored", extrusion=(0, 0, -1), elevation=7)
        model.add_lwpolyline(points, format="xyb", close=False, dxfattribs=mirrored)
    model.add_polyline2d([(x + 50, y + 7, b) for x, y, b in points], format="xyb", close=True, dxfattribs=on("polylines"))
    model.add_polyline3d([(0, 0, 5), (10, 80, 9), (-40, 50, 1)], dxfattribs=on("polylines"))

    part = document.blocks.new("part", base_point=(2, 3))
    part.add_circle((0, 0), 5, dxfattribs=on("0"))
    part.add_line((0, 0), (9, 2), dxfattribs=on("0"))
    part.add_polyline2d([(0, 0, 1), (5, 5, -0.5), (9, 0, 0)], format="xyb", dxfattribs=on("0"))
    group = document.blocks.new("group")
    group.add_blockref("part", (10, 0), dxfattribs=on("0", rotation=30, xscale=2, yscale=-1))
    group.add_blockref("part", (-10, 5), dxfattribs=on("0", xscale=0.5, yscale=0.5, zscale=0.5))
    model.add_blockref("part", (-80, 0), dxfattribs=on("blocks", xscale=3, yscale=3, rotation=45))
    model.add_blockref("part", (-80, 60), dxfattribs=on("blocks", column_count=3, row_count=2, column_spacing=20, row_spacing=15, rotation=10))
    model.add_blockref("group", (-80, -60), dxfattribs=on("nested", xscale=1.5, yscale=1.5, zscale=1.5, rotation=-20))
    model.add_blockref("group", (-120, -60), dxfattribs=on("nested", extrusion=(0, 0, -1)))
    return document


def truth(document):
    lengths, points = {}, []
    for entity in recursive_decompose(document.modelspace()):
        # ezdxf's paths leave the knots' range where a spline is closed; its curves do not
        is_spline = entity.dxftype() == "SPLINE"
        flat = list(entity.construction_tool().approximate(5000) if is_spline else make_path(entity).flattening(1e-4, segments=64))
        # seen from above
        flat = [(p.x, p.y) for p in flat]
        points += flat
        layer = entity.dxf.layer
        lengths[layer] = lengths.get(layer, 0) + length(flat)
    xs, ys = [p[0] for p in points], [p[1] for p in points]
    return lengths, (max(xs) - min(xs), max(ys) - min(ys))


def found(path, tracelight):
    run = subprocess.run([tracelight, "strokes", str(path), "--json"], capture_output=True, text=True)
    check(run.returncode == 0, run.stderr)
    document, lengths, colours = json.loads(run.stdout), {}, {}
    for stroke in document["strokes"]:
        lengths[stroke["layer"]] = lengths.get(stroke["layer"], 0) + length(dense(stroke["path"]))
        colours.setdefault(stroke["layer"], set()).add(stroke["colour"])
    return lengths, colours, (document["width_px"], document["height_px"])


def main():
    folder, tracelight = Path(sys.argv[1]), sys.argv[2]
    for version in ["R12", "R2000", "R2007", "R2018"]:
        path = folder / f"theirs-{version}.dxf"
        document = drawing(version)
        document.saveas(path)
        (wanted, size), (got, colours, sheet) = truth(document), found(path, tracelight)
        for layer, shown in colours.items():
            own = "#%02x%02x%02x" % tuple(ezdxf.colors.aci2rgb(document.layers.get(layer).color))
            # one line has a colour of its own
            own = {own, "#ff0000"} if layer == "lines" else {own}
            check(shown == own, f"{version}, {layer}: {shown} instead of {own}")
        # layer 0 within a block is the insert's, which taking apart does not say
        check("0" not in got, f"{version}: strokes on layer 0")
        got["0"] = got.pop("blocks") + got.pop("nested")
        check(set(wanted) == set(got), f"{version}: layers {sorted(got)} instead of {sorted(wanted)}")
        for layer, mm in sorted(wanted.items()):
            # how a spline passes its points is not in the format: every program has its own way
            share = 1e-2 if layer == "fit points" else 2e-4
            check(abs(got[layer] - mm) <= share * mm, f"{version}, {layer}: {got[layer]:.3f} mm instead of {mm:.3f}")
        off = max(abs(a - b) for a, b in zip(size, sheet))
        check(off <= 1e-2, f"{version}: a sheet of {sheet} instead of {size}")
        print(f"{version}: {len(wanted)} layers, {sum(wanted.values()):.1f} mm by ezdxf, {sum(got.values()):.1f} mm read")


if __name__ == "__main__":
    main()
