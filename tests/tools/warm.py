# SPDX-License-Identifier: BSD-3-Clause
"""Runs a program whose libraries are loaded already (warm_main.cpp), as subprocess.run() would run it."""

import atexit
import os
import select
import signal
import struct
import subprocess
import tempfile


class Program:
    """`server` is the program compiled with warm_main.cpp, which loads `libraries`, too; `path` is the program itself."""

    def __init__(self, path, server, *libraries):
        self.path, self.command = path, [server, *libraries]
        self.environment = dict(os.environ)
        self.process = None
        self.files = [tempfile.NamedTemporaryFile() for _ in range(2)]

    def start(self):
        self.process = subprocess.Popen(self.command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, cwd="/",
                                        start_new_session=True, bufsize=0)
        atexit.register(self.stop)

    def stop(self):
        if self.process is not None:
            self.process.stdin.close()  # on which the server ends
            self.process.wait()
            self.process.stdout.close()
            self.process = None

    def run(self, *arguments, timeout):
        """A subprocess.CompletedProcess with text. For a changed environment the program itself is started."""
        command = [self.path, *map(str, arguments)]
        if dict(os.environ) != self.environment:
            return subprocess.run(command, capture_output=True, text=True, timeout=timeout, check=False)
        if self.process is None:
            self.start()
        words = [os.getcwd(), *(file.name for file in self.files), *command]
        request = b"".join(os.fsencode(word) + b"\0" for word in words)
        self.process.stdin.write(struct.pack("=I", len(request)) + request)
        if not select.select([self.process.stdout], [], [], timeout)[0]:
            os.killpg(self.process.pid, signal.SIGKILL)
            self.stop()
            raise subprocess.TimeoutExpired(command, timeout)
        status = struct.unpack("=i", self.process.stdout.read(4))[0]
        texts = []
        for file in self.files:
            with open(file.name, encoding="utf-8", newline=None) as written:
                texts.append(written.read())
        return subprocess.CompletedProcess(command, status, *texts)
