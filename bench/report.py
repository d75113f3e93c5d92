#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Measures with pimg_bench, pimgtool and tone mapping programs, all in alternation, and prints Markdown.

    report.py PIMG_BENCH PIMGTOOL GROWTH.svg [ARGUMENT FOR PIMG_BENCH]...

Every figure is the median of five runs, every ratio is of figures of this run. Growth over size goes to GROWTH.svg. The
picture is $PIMG_BENCH_PICTURE; if it is an OpenEXR file it is tone-mapped as well.
"""
import json
import os
import resource
import shutil
import statistics
import subprocess
import sys
import tempfile

RUNS = 5

# Title, fast, slow, what is aimed at. Ratios are of items per second.
RATIOS = [
    ("Building over CGAL's Lindstrom-Turk, 512²", "build/512", "cgal/512", "≥ 45"),
    ("Building over meshoptimizer, 512²", "build/512", "meshopt_free/512", "≥ 1.3"),
    ("Building over meshoptimizer, 1024²", "build/1024", "meshopt_free/1024", "≥ 1.3"),
    ("Building over meshoptimizer with its border locked, 512²", "build/512", "meshopt_locked/512", "≥ 1.3"),
    ("Building a picture, two threads over one, 1024²", "build_image/1024/2", "build_image/1024/1", "≥ 1.8"),
    ("Retuning hdr_compress over building, two threads, 1024²", "retune_hdr_compress/1024/2", "build_image/1024/2", "≥ 25"),
    ("The same, one thread", "retune_hdr_compress/1024/1", "build_image/1024/1", "≥ 25"),
    ("Retuning, two threads, over a plain copy of its bytes, 1024²", "retune_hdr_compress/1024/2", "copy/1024", "≥ 0.4"),
    ("Time per pixel, 16 Mpixel over 1 Mpixel", "build/1024", "build/4096", "≤ 1.15"),
]
# The same with memory kept from run to run, the peers' as well: without what the kernel takes to map fresh pages.
KEPT = [(title, a, b, aim) for title, a, b, aim in RATIOS if "meshopt" in b]
KEEP_MEMORY = "glibc.malloc.mmap_max=0:glibc.malloc.trim_threshold=2000000000"
# Row, benchmark.
QUALITY = [("pimg", "quality_pimg/512"), ("CGAL's Lindstrom-Turk", "quality_cgal/512"),
           ("meshoptimizer, border free, z small", "quality_meshopt/512")]
SHARES = ("50", "10", "2", "0.5")
GROWTH = [(size, size * size / 2 ** 20) for size in (512, 1024, 2048, 4096)]


def run_benchmarks(program, arguments, tunables=""):
    """Median items per second and counters by name."""
    with tempfile.NamedTemporaryFile(suffix=".json") as out:
        subprocess.run([program, "--benchmark_out=" + out.name, "--benchmark_out_format=json",
                        "--benchmark_min_time=0.01", f"--benchmark_repetitions={RUNS}",
                        "--benchmark_enable_random_interleaving=true", *arguments], check=True, stdout=sys.stderr,
                       env={**os.environ, "GLIBC_TUNABLES": tunables or os.environ.get("GLIBC_TUNABLES", "")})
        runs = json.load(open(out.name))["benchmarks"]
    by_name = {}
    for run in runs:
        if run["run_type"] == "iteration" and not run.get("error_occurred"):
            name = run["run_name"]
            for suffix in ("/real_time", "/repeats:1", "/iterations:1"):
                name = name.removesuffix(suffix)
            by_name.setdefault(name, []).append(run)
    median = {name: statistics.median(r["items_per_second"] for r in of) for name, of in by_name.items()}
    return median, {name: of[0] for name, of in by_name.items()}


def cpu_seconds(command):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(["bash", "-c", "set -o pipefail; " + command], check=True, stdout=subprocess.DEVNULL,
                   stderr=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def tone_mapping(pimgtool, picture, folder):
    """CPU seconds from file to file: rows of (program, median)."""
    png = os.path.join(folder, "out.png")
    commands = {"pimgtool --hdr-compress": f"'{pimgtool}' --threads 1 '{picture}' --hdr-compress -o '{png}'"}
    if shutil.which("pfsin") and shutil.which("pfstmo_fattal02"):
        for name in ("fattal02", "durand02", "mantiuk06"):
            commands["pfstmo_" + name] = f"pfsin '{picture}' | pfstmo_{name} | pfsout '{png}'"
    if shutil.which("luminance-hdr-cli"):
        for name in ("fattal", "durand", "mantiuk06", "ashikhmin", "reinhard02", "lischinski", "ferradans"):
            commands["luminance-hdr-cli --tmo " + name] = f"luminance-hdr-cli -l '{picture}' --tmo {name} -o '{png}'"
    os.environ.update(OMP_NUM_THREADS="1", QT_QPA_PLATFORM="offscreen", HOME=folder)  # no window, no settings of the user's
    times = {name: [] for name in commands}
    for _ in range(RUNS):
        for name, command in commands.items():
            times[name].append(cpu_seconds(command))
    return [(name, statistics.median(t)) for name, t in times.items()]


def growth_svg(rate):
    """Nanoseconds a pixel over megapixels, both axes logarithmic in equal steps: one step is a doubling."""
    left, top, wide, high, step = 60, 20, 420, 240, 60
    names = [("build", "pimg, one thread", "#0b5fa5"), ("meshopt_free", "meshoptimizer", "#b35806")]
    points = {name: [(k, 1e9 / rate[f"{name}/{size}"]) for k, (size, _) in enumerate(GROWTH) if f"{name}/{size}" in rate]
              for name, _, _ in names}
    most = max(y for of in points.values() for _, y in of) * 1.25
    at = lambda k, y: (left + 30 + 120 * k, top + high - high * y / most)
    svg = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{left + wide + 20}" height="{top + high + 50}" '
           'font-family="sans-serif" font-size="12"><rect width="100%" height="100%" fill="white"/>']
    for y in range(0, int(most) + 1, 250):
        svg.append(f'<path d="M{left} {at(0, y)[1]:.1f}h{wide}" stroke="#ddd"/>'
                   f'<text x="{left - 8}" y="{at(0, y)[1] + 4:.1f}" text-anchor="end">{y}</text>')
    for k, (_, pixels) in enumerate(GROWTH):
        svg.append(f'<text x="{at(k, 0)[0]}" y="{top + high + 18}" text-anchor="middle">{pixels:g}</text>')
    svg.append(f'<text x="{left + wide / 2}" y="{top + high + 40}" text-anchor="middle">Mpixel</text>'
               f'<text x="14" y="{top + high / 2}" transform="rotate(-90 14 {top + high / 2})" '
               'text-anchor="middle">CPU time, ns a pixel</text>')
    for i, (name, title, colour) in enumerate(names):
        line = " ".join("{:.1f},{:.1f}".format(*at(k, y)) for k, y in points[name])
        svg.append(f'<polyline points="{line}" fill="none" stroke="{colour}" stroke-width="2"/>')
        svg += ['<circle cx="{:.1f}" cy="{:.1f}" r="4" fill="{}"/>'.format(*at(k, y), colour) for k, y in points[name]]
        svg.append(f'<text x="{left + 12}" y="{top + high - 14 - 18 * i}" fill="{colour}">{title}</text>')
    return "\n".join(svg + ["</svg>\n"])


def print_tone_mapping(pimgtool, picture):
    print(f"\n| {os.path.basename(picture)}, file to file | CPU seconds |\n|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        for name, seconds in tone_mapping(pimgtool, picture, folder):
            print(f"| {name} | {seconds:.2f} |")


def main():
    program, pimgtool, growth = sys.argv[1:4]
    picture = os.environ.get("PIMG_BENCH_PICTURE", "")
    rate, runs = run_benchmarks(program, sys.argv[4:])
    kept, _ = run_benchmarks(program, ["--benchmark_filter=^(build|meshopt_free|meshopt_locked)/(512|1024)$"], KEEP_MEMORY)
    with open("/proc/cpuinfo") as f:
        model = next((line.split(":")[1].strip() for line in f if line.startswith("model name")), "unknown")
    print(f"Machine: {model}, {os.cpu_count()} cores. Medians of {RUNS} interleaved runs on "
          f"{os.path.basename(picture) or 'the synthetic landscape'}.\n")
    print("| ratio | measured | aim |\n|---|---|---|")
    for title, a, b, aim in RATIOS:
        if a in rate and b in rate:
            print(f"| {title} | {rate[a] / rate[b]:.2f} | {aim} |")
    for title, a, b, aim in KEPT:
        if a in kept and b in kept:
            print(f"| {title}, memory kept | {kept[a] / kept[b]:.2f} | {aim} |")
    print("\n| PSNR (dB) at a share of the vertices, 512² | " + " | ".join(share + " %" for share in SHARES)
          + " | pixels not covered |\n|" + "---|" * 6)
    for title, name in QUALITY:
        if name in runs:
            levels = " | ".join(f"{runs[name]['psnr_' + share]:.2f}" for share in SHARES)
            print(f"| {title} | {levels} | {runs[name]['uncovered']:.0f} |")
    print("\n| | million a second |\n|---|---|")
    for name, value in sorted(rate.items()):
        if not name.startswith("quality"):
            print(f"| {name} | {value / 1e6:.3f} |")
    print(f"\nBuilding takes {runs['build/1024']['bytes_per_pixel']:.0f} bytes a pixel at its peak; "
          f"the hierarchy {runs['build/1024']['stored_per_pixel']:.0f}.")
    if picture.endswith(".exr"):
        print_tone_mapping(pimgtool, picture)
    with open(growth, "w") as f:
        f.write(growth_svg(rate))


main()
