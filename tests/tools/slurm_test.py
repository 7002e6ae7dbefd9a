#!/usr/bin/env python3
"""Starts a Slurm of one node (munged, slurmctld and slurmd on the loopback), runs the scripts of tools/slurm as people
do, and stops it. The hash and the files are those of one process.

usage: slurm_test.py SOURCE_DIR PSYGEN [mpi]
Exit code 77: Slurm is not installed.
"""
import json
import os
import pathlib
import pwd
import shutil
import signal
import socket
import subprocess
import sys
import tempfile

WORLD = """format = 1
[world]
name = "slurm"
seed = 5
blocks = [6, 4]
cell_m = 2
block_vertices = 33
[terrain]
octaves = 4
[[scatter]]
model = "rock"
count = 5
subdivisions = 1
"""

CONFIG = """ClusterName=psygen
SlurmctldHost={host}(127.0.0.1)
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
CredType=cred/munge
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
AccountingStorageType=accounting_storage/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
MpiDefault=none
ReturnToService=2
SchedulerParameters=batch_sched_delay=0,sched_interval=1
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldPort={ports[0]}
SlurmdPort={ports[1]}
NodeName={host} NodeAddr=127.0.0.1 CPUs={cpus} State=UNKNOWN
PartitionName=main Nodes=ALL Default=YES MaxTime=INFINITE State=UP
"""

LIMIT_S = 240  # of a job that hangs
PROGRAMS = ["munged", "slurmctld", "slurmd", "sbatch"]


def program(name):
    """The path of a program; daemons are outside of the PATH of most users."""
    return shutil.which(name) or shutil.which(name, path="/usr/sbin:/sbin")


def free_ports(count):
    sockets = [socket.socket() for _ in range(count)]
    for each in sockets:
        each.bind(("127.0.0.1", 0))
    ports = [each.getsockname()[1] for each in sockets]
    for each in sockets:
        each.close()
    return ports


class Slurm:
    """A Slurm in a folder, from `with` to its end."""

    def __init__(self, folder):
        self.folder, self.daemons, self.munged = folder, [], None
        (folder / "state").mkdir()
        (folder / "spool").mkdir()
        host = socket.gethostname().split(".")[0]
        config = CONFIG.format(host=host, user=pwd.getpwuid(os.getuid()).pw_name, folder=folder,
                               ports=free_ports(2), cpus=os.cpu_count())
        (folder / "slurm.conf").write_text(config, encoding="utf-8")
        self.environment = {**os.environ, "SLURM_CONF": str(folder / "slurm.conf")}

    def start_munged(self):
        key = self.folder / "munge.key"
        key.write_bytes(os.urandom(128))
        key.chmod(0o600)
        self.munged = [program("munged"), "--force", f"--key-file={key}", f"--socket={self.folder}/munge.socket",
                       f"--pid-file={self.folder}/munged.pid", f"--log-file={self.folder}/munged.log",
                       f"--seed-file={self.folder}/munge.seed"]
        subprocess.run(self.munged, check=True, capture_output=True)  # returns when the daemon listens

    def start(self, name, ready, *options):
        """Starts a daemon, and reads its output until it is ready."""
        daemon = subprocess.Popen([program(name), "-D", "-v", "-f", self.folder / "slurm.conf", *options], text=True,
                                  env=self.environment, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        self.daemons.append(daemon)
        said = []
        for line in daemon.stderr:
            said.append(line)
            if ready in line:
                break
        else:
            raise AssertionError(f"{name} ended at its start:\n{''.join(said[-20:])}")
        # Keeps reading, so that the daemon never blocks.
        subprocess.Popen(["cat"], stdin=daemon.stderr, stdout=subprocess.DEVNULL)

    def __enter__(self):
        try:
            self.start_munged()
            self.start("slurmctld", "Running as primary controller", "-c")
            self.start("slurmd", "slurmd started")
        except BaseException:
            self.stop()
            raise
        return self

    def stop(self):
        for daemon in reversed(self.daemons):
            daemon.send_signal(signal.SIGTERM)
            try:
                daemon.wait(timeout=LIMIT_S)
            except subprocess.TimeoutExpired:
                daemon.kill()
        if self.munged:
            subprocess.run([*self.munged, "--stop"], capture_output=True)  # returns when it has ended

    def __exit__(self, *_):
        self.stop()

    def run(self, *arguments, output):
        """Submits a script, waits for its end, and returns its output."""
        job = subprocess.run([program("sbatch"), "--wait", f"--output={self.folder / output}", f"--chdir={self.folder}", *arguments],
                             env=self.environment, capture_output=True, text=True)
        said = "".join(each.read_text(encoding="utf-8") for each in sorted(self.folder.glob(output.replace("%a", "*"))))
        assert job.returncode == 0, f"{arguments}: {job.stderr}{said}"
        return said


def blocks_in(folder):
    return {file.name: file.read_bytes() for file in folder.iterdir() if file.suffix != ".ledger"}


def main():
    source, psygen = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
    missing = [name for name in PROGRAMS if not program(name)]
    if missing:
        print(f"skipped: {', '.join(missing)} not installed (Debian: slurm-wlm, munge)")
        return 77
    with_mpi = len(sys.argv) > 3 and shutil.which("mpirun")
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))  # stops the daemons
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        folder.chmod(0o755)  # munge wants to know that nobody else can write here
        (folder / "slurm.toml").write_text(WORLD, encoding="utf-8")
        os.environ["PSYGEN"] = str(psygen)
        world = ["--world", str(folder / "slurm.toml")]
        alone = json.loads(subprocess.run([psygen, "amplify", *world, "--threads", "1", "--json", "--out", folder / "alone"],
                                          check=True, capture_output=True, text=True).stdout)
        scripts = source / "tools/slurm"
        with Slurm(folder) as slurm:
            slurm.run("--array=1-3", scripts / "shards.sh", "3", folder / "shards", *world, output="shards-%a.txt")
            slurm.run("--array=2", scripts / "shards.sh", "3", folder / "shards", *world, output="again-%a.txt")
            merged = slurm.run(scripts / "merge.sh", folder / "shards", "--json", output="merge.txt")
            assert json.loads(merged)["hash"] == alone["hash"], merged
            assert blocks_in(folder / "shards") == blocks_in(folder / "alone")
            assert len(list(folder.glob("shards-*.txt"))) == 3
            assert "0 written, 0 existed" in (folder / "again-2.txt").read_text(), "a finished shard was made again"
            if with_mpi:
                os.environ.update(OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
                                  OMPI_MCA_btl="self,vader", OMPI_MCA_btl_vader_single_copy_mechanism="none")
                slurm.environment.update(os.environ)
                said = slurm.run("--ntasks=2", "--overcommit", scripts / "mpi.sh", folder / "job", *world, "--json", output="mpi.txt")
                job = json.loads(said)
                assert job["hash"] == alone["hash"] and job["ranks"] == 2, said
                assert blocks_in(folder / "job") == blocks_in(folder / "alone")
    print("slurm: " + ("shards, merge and MPI" if with_mpi else "shards and merge") + " have the hash and the files of one process")
    return 0


if __name__ == "__main__":
    sys.exit(main())
