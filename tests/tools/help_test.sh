#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# What is made of the command table: the manual page as groff sees it, and what bash completes.
set -euo pipefail

fail() { echo "$*"; exit 1; }

"$PIMGTOOL" --help:format=man >pimgtool.1
if command -v groff >/dev/null; then
    groff -man -Tutf8 -ww pimgtool.1 >manual.txt 2>warnings.txt
    [[ ! -s warnings.txt ]] || fail "$(cat warnings.txt)"
    grep -q "hdr.compress" manual.txt
fi
grep -q '^\\fB\\-\\-hdr\\-compress\\fR' pimgtool.1

"$PIMGTOOL" --help:format=bash >completion.bash
# shellcheck source=/dev/null
source completion.bash
compopt() { :; }  # works in a completion only

expect() { # line, words expected among the replies, or "" for none
    COMP_LINE=$1 COMP_POINT=${#1}
    _pimgtool
    local word
    for word in $2; do
        [[ " ${COMPREPLY[*]} " == *" $word "* ]] || fail "'$1': ${COMPREPLY[*]-nothing}; expected $word"
    done
    [[ -n $2 || ${#COMPREPLY[@]} -eq 0 ]] || fail "'$1': ${COMPREPLY[*]}; expected nothing"
}

touch "picture one.exr"
expect "pimgtool in.exr --hdr" "--hdr-compress"
expect "pimgtool in.exr --" "--level --ociodisplay --shot-stats"
expect "pimgtool in.exr --hdr-compress:" "s0= beta= key="
expect "pimgtool in.exr --hdr-compress:beta=10:dm" "dmax="
expect "pimgtool in.exr --segment:regions=9:output=" "labels mean"
expect "pimgtool in.exr --segment:output=l" "labels"
expect "pimgtool in.exr --hdr-compress:fit=" "0 1"
expect "pimgtool in.exr -d ui" "uint8 uint16"
expect "pimgtool pict" "picture one.exr"
expect "pimgtool in.exr --no-such" ""
[[ $(complete -p pimgtool) == "complete -F _pimgtool pimgtool" ]]
