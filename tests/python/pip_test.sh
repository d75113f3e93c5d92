#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# `pip install .` without a network into a fresh environment that sees the system's packages, and the module's tests there.
# Environment: PYTHON SOURCE BUILD, set by tests/CMakeLists.txt. Compiles nothing again: takes the module from BUILD.
set -euo pipefail
here=$PWD
rm -rf venv
"$PYTHON" -m venv --system-site-packages venv
export PIP_NO_INDEX=1 PIP_DISABLE_PIP_VERSION_CHECK=1
(cd "$SOURCE" && "$here/venv/bin/python" -m pip install --quiet . --config-settings "build-dir=$BUILD")
venv/bin/python -c "import pimg, sys; assert pimg.__file__.startswith(sys.prefix), pimg.__file__"
venv/bin/python -m pip show pimg | grep -x "Name: pimg"
venv/bin/python "$SOURCE/tests/python/module_test.py"
venv/bin/python -m pip uninstall --quiet --yes pimg
