#!/usr/bin/env python3
"""Takes a picture of a replay page: the scene at one time, without the plots.

    scripts/replay_picture.py PAGE.html PICTURE.png [--time 2.5] [--scene 1] [--size 800x450] [--keys ...]

It opens a copy of the page in headless chromium. The address `#1/2.5` of a page names its scene and time.
`--keys` are keys of the page, pressed before the picture is taken: `+` and `-` zoom, `w a s d` turn, `c` hides
impulses, `x` is x-ray. The picture has 256 colours, so that it is small.
"""
import argparse
import struct
import subprocess
import sys
import tempfile
import zlib
from collections import Counter
from pathlib import Path

# What is no part of the scene is out of sight, and the scene fills the window.
# The page draws its plots all the same: they keep a size.
STYLE = """<style>header, nav, footer, #tables, #transport, #toggles, #caption, #legend label { display: none !important }
#plots { visibility: hidden }
body { margin: 0 !important; padding: 0 !important; max-width: none !important }
#replay, #stage { display: block !important; margin: 0 !important; padding: 0 !important }
#frame { position: fixed !important; inset: 0; z-index: 9; width: 100vw !important; height: 100vh !important; margin: 0 !important;
  border: 0 !important; border-radius: 0 !important }
#view { width: 100% !important; height: 100% !important }</style>"""


def keys_script(keys):
    pressed = ", ".join(f"'{key}'" for key in keys)
    return f"""<script>for (const key of [{pressed}])
  document.getElementById('view').dispatchEvent(new KeyboardEvent('keydown', {{key, bubbles: true}}));</script>"""


def rows_of(png):
    """Width, bytes a pixel and rows of a PNG of 8 bits a channel, RGB or RGBA, as chromium writes it."""
    at, packed = 8, b""
    while at < len(png):
        size, kind = struct.unpack(">I4s", png[at : at + 8])
        body = png[at + 8 : at + 8 + size]
        if kind == b"IHDR":
            width, height, bits, colour = struct.unpack(">IIBB", body[:10])
            assert bits == 8 and colour in (2, 6), "not a PNG of RGB or RGBA"
        packed += body if kind == b"IDAT" else b""
        at += size + 12
    n = 3 if colour == 2 else 4
    data, above, rows = zlib.decompress(packed), bytearray(width * n), []
    for y in range(height):
        start = y * (width * n + 1)
        filtered, row = data[start], bytearray(data[start + 1 : start + 1 + width * n])
        for i in range(len(row)):
            a, b, c = (row[i - n] if i >= n else 0), above[i], (above[i - n] if i >= n else 0)
            nearest = min((abs(b - c), 0, a), (abs(a - c), 1, b), (abs(a + b - 2 * c), 2, c))[2]
            row[i] = (row[i] + (0, a, b, (a + b) // 2, nearest)[filtered]) % 256
        rows.append(row)
        above = row
    return width, n, rows


def shrink(path):
    """Writes a PNG again with 256 colours."""
    width, n, rows = rows_of(path.read_bytes())
    pixels = [[tuple(v & 0xFC for v in row[i : i + 3]) for i in range(0, width * n, n)] for row in rows]
    palette = [colour for colour, _ in Counter(p for row in pixels for p in row).most_common(256)]
    place = {colour: k for k, colour in enumerate(palette)}

    def index(p):
        if p not in place:
            place[p] = min(range(len(palette)), key=lambda k: sum((a - b) ** 2 for a, b in zip(p, palette[k])))
        return place[p]

    def chunk(kind, body):
        return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))

    data = b"".join(b"\0" + bytes(index(p) for p in row) for row in pixels)
    head = struct.pack(">IIBBBBB", width, len(rows), 8, 3, 0, 0, 0)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"PLTE", bytes(v for p in palette for v in p))
                     + chunk(b"IDAT", zlib.compress(data, 9)) + chunk(b"IEND", b""))


def main():
    options = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    options.add_argument("page", type=Path)
    options.add_argument("picture", type=Path)
    options.add_argument("--time", type=float, default=0, help="s of the replay")
    options.add_argument("--scene", type=int, default=1, help="counted from 1")
    options.add_argument("--size", default="800x450")
    options.add_argument("--keys", default="", help="for example ++dd")
    options.add_argument("--browser", default="chromium")
    given = options.parse_args()

    text = given.page.read_text(encoding="utf-8")
    text = text.replace("</head>", STYLE + "</head>", 1)
    head, close, tail = text.rpartition("</body>")
    text = head + keys_script(given.keys) + close + tail
    with tempfile.TemporaryDirectory() as folder:
        copy = Path(folder, "page.html")
        copy.write_text(text, encoding="utf-8")
        given.picture.parent.mkdir(parents=True, exist_ok=True)
        subprocess.run(
            [given.browser, "--headless", "--no-sandbox", "--disable-gpu-sandbox", "--use-angle=swiftshader",
             "--enable-unsafe-swiftshader", "--hide-scrollbars", f"--user-data-dir={folder}/profile",
             f"--window-size={given.size.replace('x', ',')}", "--virtual-time-budget=2000",
             "--run-all-compositor-stages-before-draw",
             f"--screenshot={given.picture.resolve()}", f"file://{copy}#{given.scene}/{given.time or 1e-9:.9f}"],
            check=True, timeout=180, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    shrink(given.picture)
    print(f"{given.picture}: {given.picture.stat().st_size // 1000} kB")


if __name__ == "__main__":
    sys.exit(main())
