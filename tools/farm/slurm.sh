#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Renders a shot on a Slurm cluster: one job that measures it, then an array with one task per frame:
#     slurm.sh FIRST-LAST SHOT.json in.#.exr --hdr-compress -o out.#.exr
# The shot is measured into SHOT.json unless that is there. $PIMGTOOL is the tool; sbatch takes its own settings from
# $SBATCH_PARTITION and so on. Prints the number of the array's job.
set -euo pipefail
if (($# < 3)) || [[ ! $1 =~ ^[0-9]+-[0-9]+$ ]]; then
    echo "usage: ${0##*/} FIRST-LAST SHOT.json ARGUMENTS OF PIMGTOOL..." >&2
    exit 2
fi
range=$1 shot=$2
shift 2
tool=${PIMGTOOL:-pimgtool}

# The command line of a task, quoted for the shell that runs it.
task() { printf '%q ' "$tool" "$@"; }

after=()
if [[ ! -e $shot ]]; then
    measure=$(env -u SBATCH_WAIT sbatch --parsable --job-name=pimg-measure \
        --wrap "$(task --frames "$range" --parallel-frames "$@" --shot-stats:render=0 "$shot")")
    after=(--dependency "afterok:${measure%%;*}" --kill-on-invalid-dep=yes)
fi
sbatch --parsable --job-name=pimg-render --array="$range" "${after[@]}" \
    --wrap "$(task "$@" --shot-stats "$shot") --frames \$SLURM_ARRAY_TASK_ID --threads \${SLURM_CPUS_PER_TASK:-1}"
