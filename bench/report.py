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
import time

RUNS = 5

# Title, fast, slow, what is aimed at. Ratios are of items per second.
RATIOS = [
    ("Building over CGAL's Lindstrom-Turk, 512²", "build/512", "cgal/512", "≥ 45"),
    ("Building over meshoptimizer, 512²", "build/512", "meshopt_free/512", "≥ 1.3"),
    ("Building over meshoptimizer, 1024²", "build/1024", "meshopt_free/1024", "≥ 1.3"),
    ("Building over meshoptimizer with its border locked, 512²", "build/512", "meshopt_locked/512", "≥ 1.3"),
    ("Building a picture, two threads over one, 1024²", "build_image/auto/1024/2", "build_image/auto/1024/1", "≥ 1.8"),
    ("Building by mesh=auto over mesh=full, two threads, 1024²", "build_image/auto/1024/2", "build_image/full/1024/2", "≥ 2"),
    ("Building a preview over mesh=full, two threads, 1024²", "build_image/preview/1024/2", "build_image/full/1024/2", "≥ 4"),
    ("Retuning hdr_compress over building, two threads, 1024²", "retune/hdr_compress/1024/2", "build_image/auto/1024/2", "≥ 25"),
    ("The same, one thread", "retune/hdr_compress/1024/1", "build_image/auto/1024/1", "≥ 25"),
    *((f"Retuning {name}, two threads, over a plain copy of the bytes of hdr_compress, 1024²", f"retune/{name}/1024/2",
       "copy/1024", "≥ 0.4") for name in ("hdr_compress", "lowpass_strength", "lowpass_fraction", "enhance_gain",
                                          "enhance_strength", "level", "segment")),
    ("Retuning hdr_compress, two threads, 8.3 over 1 Mpixel, per pixel", "retune/hdr_compress/1024/2",
     "retune/hdr_compress/2880/2", "≤ 0.8"),
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


def seconds(command, environment):
    """CPU and wall time of a command of the shell."""
    before, start = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    subprocess.run(["bash", "-c", "set -o pipefail; " + command], check=True, stdout=subprocess.DEVNULL,
                   stderr=subprocess.DEVNULL, env={**os.environ, **environment})
    after, wall = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter() - start
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, wall


def tone_mapping_commands(pimgtool, picture, png, threads):
    """Commands from file to file, by name."""
    pimg = f"'{pimgtool}' --threads {threads} '{picture}'"
    commands = {"pimgtool --hdr-compress": f"{pimg} --hdr-compress -o '{png}'",
                "pimgtool --build:mesh=full --hdr-compress": f"{pimg} --build:mesh=full --hdr-compress -o '{png}'",
                "pimgtool --build:preview=1 --hdr-compress": f"{pimg} --build:preview=1 --hdr-compress -o '{png}'"}
    if threads == 1 and shutil.which("pfsin") and shutil.which("pfstmo_fattal02"):
        for name in ("fattal02", "durand02", "mantiuk06"):
            commands["pfstmo_" + name] = f"pfsin '{picture}' | pfstmo_{name} | pfsout '{png}'"
    if shutil.which("luminance-hdr-cli"):
        for name in ("fattal", "durand", "mantiuk06", "ashikhmin", "reinhard02", "lischinski", "ferradans"):
            commands["luminance-hdr-cli --tmo " + name] = f"luminance-hdr-cli -l '{picture}' --tmo {name} -o '{png}'"
    return commands


def tone_mapping(pimgtool, picture, folder):
    """Rows of (program, threads, CPU seconds, wall seconds): medians, file to file, all by turns."""
    png = os.path.join(folder, "out.png")
    all_of = {(name, threads): command for threads in (1, 2)
              for name, command in tone_mapping_commands(pimgtool, picture, png, threads).items()}
    times = {key: [] for key in all_of}
    for _ in range(RUNS):
        for (name, threads), command in all_of.items():  # no window, no settings of the user's
            times[name, threads].append(seconds(command, {"OMP_NUM_THREADS": str(threads), "HOME": folder,
                                                          "QT_QPA_PLATFORM": "offscreen"}))
    return [(*key, *(statistics.median(t[i] for t in of) for i in (0, 1))) for key, of in times.items()]


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
    print(f"\n| {os.path.basename(picture)}, file to file | threads | CPU seconds | wall seconds |\n|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        for name, threads, cpu, wall in tone_mapping(pimgtool, picture, folder):
            print(f"| {name} | {threads} | {cpu:.2f} | {wall:.2f} |")


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
