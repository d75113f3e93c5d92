#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Renders a shot on this machine, every frame in a process of its own:
#     xargs.sh FIRST-LAST SHOT.json in.#.exr --hdr-compress -o out.#.exr
# The shot is measured once, into SHOT.json, unless that is there. $JOBS processes at a time (as many as cores),
# $PIMGTOOL is the tool.
set -euo pipefail
if (($# < 3)) || [[ ! $1 =~ ^[0-9]+-[0-9]+$ ]]; then
    echo "usage: ${0##*/} FIRST-LAST SHOT.json ARGUMENTS OF PIMGTOOL..." >&2
    exit 2
fi
range=$1 shot=$2
shift 2
tool=${PIMGTOOL:-pimgtool}

[[ -e $shot ]] || "$tool" --frames "$range" --parallel-frames "$@" --shot-stats:render=0 "$shot"
seq "${range%-*}" "${range#*-}" |
    xargs -P "${JOBS:-$(nproc)}" -I{frame} "$tool" --threads 1 --frames {frame} "$@" --shot-stats "$shot"
