#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Arrays of any shape, type, order and view given to the Python module: a result of the right shape, or an exception that
says why not in one line. Python has no coverage for libFuzzer to follow, so the inputs are drawn by a number: the same
number, the same array. What ended the process is named by the last line of the file LAST.

usage: python_buffer.py FIRST COUNT
"""
import sys

import numpy as np

import pimg

TYPES = ["u1", "u2", "u4", "u8", "i1", "i2", "i4", "f2", "f4", "f8", ">f4", ">u2", "c8", "?", "S3", "U2", "O", "M8[s]",
         [("r", "f4"), ("g", "f4")]]
EXPECTED = (TypeError, ValueError, MemoryError, OverflowError)


def base_array(rng):
    dtype = np.dtype(TYPES[rng.integers(len(TYPES))] if rng.random() < 0.4 else ["u1", "u2", "f2", "f4", "f8"][rng.integers(5)])
    shape = tuple(int(n) for n in rng.choice([0, 1, 2, 3, 4, 5, 7, 12, 17], size=rng.choice([0, 1, 2, 3, 3, 3, 4, 5])))
    if dtype.kind == "O":
        return np.full(shape, rng.choice([1, "a", None]), dtype)
    return np.frombuffer(rng.bytes(max(1, int(np.prod(shape))) * dtype.itemsize), dtype)[:int(np.prod(shape))].reshape(shape)


def view_of(rng, array):
    """The same memory seen otherwise: reversed, skipped, transposed, broadcast, overlapping, of a subclass, read-only."""
    for _ in range(rng.integers(3)):
        kind = rng.integers(9)
        if kind == 0 and array.ndim:
            array = np.flip(array, rng.integers(array.ndim))
        elif kind == 1:
            array = array.T
        elif kind == 2 and array.ndim:
            array = array[::int(rng.integers(1, 4))]
        elif kind == 3 and array.ndim < 4:
            array = np.broadcast_to(array, (3,) + array.shape)
        elif kind == 4 and array.ndim and array.shape[0] > 2:
            array = np.lib.stride_tricks.sliding_window_view(array, 2, 0)
        elif kind == 5:
            array = np.asfortranarray(array)
        elif kind == 6:
            array = np.ma.masked_array(array)
        elif kind == 7 and array.ndim == 2 and array.dtype.names is None:
            array = np.asmatrix(array)
        elif kind == 8:
            array = array.view()
            array.flags.writeable = False
    return array


def wrapped(rng, array):
    """Objects that hold an array by other protocols."""
    kind = rng.integers(12)
    if kind == 0:
        return array.tolist()
    if kind == 1 and array.dtype.kind in "uif":
        return memoryview(array)
    if kind == 2:
        return type("Interface", (), {"__array__": lambda self, *a, **k: array})()
    if kind == 3:
        return bytes(array.tobytes())
    return array


def region(rng):
    if rng.random() < 0.6:
        return {}
    bounds = [int(n) for n in rng.choice([-2**31, -7, -1, 0, 1, 3, 9, 2**31 - 1, 2**40], size=rng.choice([3, 4, 4, 4]))]
    return {"roi": tuple(bounds)}


def one(number):
    rng = np.random.default_rng(number)
    array = wrapped(rng, view_of(rng, base_array(rng)))
    call = [pimg.level, pimg.feature_lowpass, pimg.hdr_compress, pimg.ProgressiveImage][rng.integers(4)]
    keywords = region(rng) if call is not pimg.ProgressiveImage else {}
    try:
        result = call(array, **keywords)
    except EXPECTED as error:
        assert str(error) and "\n" not in str(error)[:-1] and len(str(error)) < 2000, repr(error)
        return False
    if isinstance(result, np.ndarray) and not keywords:
        assert result.shape[:2] == array.shape[:2], (result.shape, array.shape)
    return True


def main(first, count):
    used = 0
    with open("LAST", "w") as last:
        for number in range(first, first + count):
            last.seek(0)
            last.write(f"{number}\n")
            last.flush()
            used += one(number)
    print(f"{count} inputs, {used} of them pictures")
    return 0 if used else 1


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    sys.exit(main(int(sys.argv[1]), int(sys.argv[2])))
