# SPDX-License-Identifier: BSD-3-Clause
"""tools/farm/slurm.sh on a cluster of one node, started here. Skipped, saying why, where Slurm is missing or cannot start."""

import contextlib
import getpass
import os
import pathlib
import shutil
import socket
import subprocess
import time
import unittest

import pictures

SCRIPT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../../tools/farm/slurm.sh")
PROGRAMS = ("munged", "slurmctld", "slurmd", "sbatch", "sinfo")

CONFIG = """\
ClusterName=test
SlurmctldHost={host}(127.0.0.1)
SlurmUser={user}
SlurmdUser={user}
SlurmctldPort={ports[0]}
SlurmdPort={ports[1]}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
CredType=cred/munge
MpiDefault=none
ProctrackType=proctrack/pgid
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
ReturnToService=2
SchedulerParameters=batch_sched_delay=0,sched_interval=1
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
NodeName={host} NodeAddr=127.0.0.1 CPUs=2
PartitionName=all Nodes=ALL Default=YES
"""


def free_ports(count):
    with contextlib.ExitStack() as stack:
        sockets = [stack.enter_context(socket.socket()) for _ in range(count)]
        for one in sockets:
            one.bind(("127.0.0.1", 0))
        return [one.getsockname()[1] for one in sockets]


class Slurm(pictures.ToolTest):
    def setUp(self):
        super().setUp()
        os.environ["PATH"] += ":/usr/sbin:/sbin"
        missing = [program for program in PROGRAMS if not shutil.which(program)]
        if missing:
            self.skipTest(f"no {', '.join(missing)}: install slurm-wlm")
        if os.geteuid() != 0:
            self.skipTest("slurmd runs jobs as root only")
        folder = os.getcwd()
        os.chmod(folder, 0o755)
        for name in ("state", "spool"):
            os.mkdir(name)
        with open("munge.key", "wb") as key:
            key.write(os.urandom(64))
        os.chmod("munge.key", 0o400)
        with open("slurm.conf", "w", encoding="utf-8") as config:
            config.write(CONFIG.format(host=socket.gethostname().split(".")[0], user=getpass.getuser(), folder=folder,
                                       ports=free_ports(2)))
        self.environment = {**os.environ, "SLURM_CONF": f"{folder}/slurm.conf", "PIMGTOOL": pictures.TOOL}
        self.start("munged", "--foreground", "--force", f"--socket={folder}/munge.socket",
                   f"--key-file={folder}/munge.key", f"--pid-file={folder}/munged.pid",
                   f"--log-file={folder}/munged.log", f"--seed-file={folder}/munged.seed", "--num-threads=1")
        self.wait_for("munged", lambda: os.path.exists("munge.socket"))
        self.start("slurmctld", "-D")
        self.start("slurmd", "-D")
        self.wait_for("a node", lambda: "idle" in self.output("sinfo", "--noheader", "--format=%T"))

    def start(self, program, *arguments):
        log = open(f"{program}.out", "w", encoding="utf-8")  # pylint: disable=consider-using-with
        daemon = subprocess.Popen([program, *arguments], stdout=log, stderr=log, env=self.environment)
        log.close()

        def stop():
            daemon.terminate()
            try:
                daemon.wait(10)
            except subprocess.TimeoutExpired:
                daemon.kill()
                daemon.wait()

        self.addCleanup(stop)

    def output(self, *command):
        return subprocess.run(command, capture_output=True, text=True, env=self.environment, check=False).stdout

    def wait_for(self, what, there, seconds=20):
        end = time.time() + seconds
        while not there():
            if time.time() > end:
                logs = "".join(f" {path}: {path.read_text()[-300:]}" for path in pathlib.Path().glob("*.out"))
                self.skipTest(f"{what} did not start in {seconds} s:{logs}")
            time.sleep(0.2)

    def test_a_shot_is_measured_and_rendered_frame_by_frame(self):
        for frame in range(1, 4):
            pictures.write(f"in {frame:04d}.exr", pictures.hdr_scene(40, 30) * frame, "half")
        shot = ("in #.exr", "--hdr-compress")
        done = subprocess.run([SCRIPT, "1-3", "shot.json", *shot, "-o", "out.#.exr"], text=True, check=False,
                              capture_output=True, timeout=100, env={**self.environment, "SBATCH_WAIT": "1"})
        said = "".join(path.read_text() for path in pathlib.Path().glob("slurm-*.out"))
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr + said)
        self.ok("--frames", "1-3", *shot, "--shot-stats", "one.json", "-o", "one.#.exr")
        for frame in range(1, 4):
            self.assert_same(f"out.{frame:04d}.exr", f"one.{frame:04d}.exr")


if __name__ == "__main__":
    unittest.main()
