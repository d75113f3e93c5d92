#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Hands in pimgview's window, under Xvfb with Mesa's software OpenGL: random ones, and where xdotool is there, those of a user
# who drags, zooms, undoes, orders filters, and closes the window while a picture is being built.
set -euo pipefail

if [[ ${DISPLAY_OF_TEST:-} != "${DISPLAY:-}" || -z ${DISPLAY:-} ]]; then
    # shellcheck disable=SC2016
    exec xvfb-run -a -s "-screen 0 1280x1024x24" bash -c 'DISPLAY_OF_TEST=$DISPLAY exec bash "$0"' "$0"
fi
export LIBGL_ALWAYS_SOFTWARE=1 XDG_CONFIG_HOME=$PWD/config XDG_DATA_HOME=$PWD/data
rm -rf config data

"$PYTHON" - <<'PY'
import numpy, OpenImageIO as oiio
def write(name, pixels, kind):
    spec = oiio.ImageSpec(pixels.shape[1], pixels.shape[0], 3, kind)
    out = oiio.ImageOutput.create(name)
    assert out.open(name, spec) and out.write_image(pixels) and out.close()
random = numpy.random.default_rng(1)
y, x = numpy.mgrid[0:150, 0:200]
light = numpy.exp2(6 * numpy.sin(x / 40) + y / 60) * (1 + 0.1 * random.random((150, 200)))
rgb = numpy.stack([light, light * 0.7, light * 0.4 + 0.01], -1).astype(numpy.float32)
write("scene.exr", rgb, "half")
write("photo.png", (255 * numpy.clip(rgb / 64, 0, 1) ** 0.45).astype(numpy.uint8), "uint8")
write("large.exr", random.random((2000, 2500, 3), numpy.float32), "half")
PY

# Random keys, clicks, drags and turns of the wheel. PIMG_RANDOM_EVENTS asks for more than a test can play.
"$PIMGVIEW" scene.exr photo.png --script "--hdr-compress --detail-enhance" --random-events "${PIMG_RANDOM_EVENTS:-300}" \
    --seed "${PIMG_SEED:-1}" --size 800x600

command -v xdotool >/dev/null || exit 0

begin() { # arguments...
    "$PIMGVIEW" "$@" --size 800x900 &
    pid=$!
    window=$(xdotool search --sync --onlyvisible --name pimgview | head -1)
    xdotool windowfocus "$window" || true
}
close() { # seconds that it may take
    local before=$SECONDS
    for _ in 1 2 3 4 5; do
        xdotool key --window "$window" q 2>/dev/null || break
        sleep 0.2
    done
    wait "$pid"
    [[ $((SECONDS - before)) -le $1 ]] || { echo "closing took $((SECONDS - before)) s" >&2 && exit 1; }
}
# A window on a busy machine looks at the pointer a few times a second: it rests at both ends, and goes by where nothing is.
drag() { # x y to_x to_y
    xdotool mousemove --window "$window" "$1" "$2" sleep 0.5 mousedown 1 sleep 0.5 mousemove --window "$window" \
        345 $((($2 + $4) / 2)) sleep 0.3 mousemove --window "$window" "$3" "$4" sleep 0.5 mouseup 1 sleep 0.3
}
press() { xdotool key --window "$window" "$@" sleep 0.1; }
titled() { # pattern: the file and the operations in the title, sooner or later
    local title=""
    for _ in {1..100}; do
        title=$(xdotool getwindowname "$window")
        [[ $title =~ ^"pimgtool "$1" -o out.png - pimgview"$ ]] && return
        sleep 0.1
    done
    echo "expected \"$1\", found \"$title\"" >&2
    exit 1
}
shows() { titled "scene\.exr$1"; } # pattern: the operations

# The picture is dragged and zoomed, everything is switched on and off, and nothing of that is in the stack.
begin scene.exr --script "--hdr-compress:beta=20"
shows " --hdr-compress:beta=20"
drag 600 300 660 340
xdotool mousemove --window "$window" 600 300 click --repeat 3 4 click 5
press s d d b m p c h w t Tab Tab ctrl+c F1 F1
shows " --hdr-compress:beta=20"
close 10
grep -q "^last=pimgtool --hdr-compress:beta=20" config/pimg/pimgview
grep -q "^window=800x900" config/pimg/pimgview

# Places in a window that looks as it does at first: titles of two filters, and the first slider of the upper one.
first=137 second=275 slider=160
begin scene.exr --script "--level:fraction=0.5 --detail-enhance:gain=2"
shows " --level:fraction=0.5 --detail-enhance:gain=2"
drag 150 $second 150 $first
shows " --detail-enhance:gain=2 --level:fraction=0.5"
press ctrl+z
shows " --level:fraction=0.5 --detail-enhance:gain=2"
press ctrl+y
shows " --detail-enhance:gain=2 --level:fraction=0.5"
drag 155 $slider 170 $slider
shows " --detail-enhance:gain=([3-9]|[0-9]+\.[0-9]+) --level:fraction=0.5"
xdotool mousemove --window "$window" 120 $slider sleep 0.2 keydown ctrl sleep 0.2 click 1 sleep 0.2 keyup ctrl sleep 0.2 \
    type --delay 100 "1.25"
press Return
shows " --detail-enhance:gain=1.25 --level:fraction=0.5"
for pause in {60,120,180,240}{,,}; do # slow frames see two clicks only if they are far enough apart
    xdotool click --repeat 2 --delay "$pause" 1 sleep 0.7
    [[ $(xdotool getwindowname "$window") == *gain* ]] || break
done
shows " --detail-enhance --level:fraction=0.5"
xdotool mousemove --window "$window" 17 $first sleep 0.2 click 1
shows " --level:fraction=0.5"
press Page_Down Page_Up ctrl+z
shows " --detail-enhance --level:fraction=0.5"
close 10

# Files are dropped on a window that is open: one with letters that URIs must encode, and several of which some cannot be read.
cp photo.png "a % b.png"
head -c 500 scene.exr >cut.exr
begin
"$PYTHON" "$(dirname "$0")/drop.py" "$window" "a % b.png"
titled "'.*/a % b.png'"
"$PYTHON" "$(dirname "$0")/drop.py" "$window" nowhere.exr cut.exr scene.exr
titled ".*/nowhere.exr"
press Page_Down
titled ".*/cut.exr"
press Page_Down
titled ".*/scene.exr"
close 10

# Closing waits for nothing, and the smallest window there is does no harm.
begin large.exr --script "--hdr-compress"
for size in "1 1" "300 20" "800 900"; do
    # shellcheck disable=SC2086
    xdotool windowsize "$window" $size sleep 0.2
done
close 5
