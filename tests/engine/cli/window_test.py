#!/usr/bin/env python3
"""Flights in a window under Xvfb: resize, minimise, restore, press keys, close; and the outputs at the end
of a path while the window stays.

usage: window_test.py PSYGEN SOURCE_DIR

Fails on a wrong exit code, a validation message, or an image that was not written.
"""
import csv
import json
import os
import pathlib
import subprocess
import sys
import tempfile
import time

SHORT_PATH = """format = 1
[path]
name = "half a second"
origin_block = [256, 256]
[[point]]
time_s = 0
at_m = [0, 0]
height_m = 1.7
[[point]]
time_s = 0.5
at_m = [1, 0]
height_m = 1.7
"""
PATIENCE_S = 240  # for a slow machine; nothing below depends on how fast it is


def wait_for(what, condition):
    """Polls until condition() is true; returns its value."""
    end = time.monotonic() + PATIENCE_S
    while time.monotonic() < end:
        value = condition()
        if value:
            return value
        time.sleep(0.05)
    raise AssertionError(f"no {what} after {PATIENCE_S} s")


class Display:
    """An X server with a window manager."""

    def __enter__(self):
        read_end, write_end = os.pipe()
        self.server = subprocess.Popen(
            ["Xvfb", "-displayfd", str(write_end), "-screen", "0", "1024x768x24", "-nolisten", "tcp"],
            pass_fds=[write_end], stderr=subprocess.DEVNULL)
        os.close(write_end)
        with os.fdopen(read_end) as pipe:
            number = pipe.readline().strip()
        # Leaks of drivers, which psygen has unloaded when the leak checker looks, have no names.
        self.environment = dict(os.environ, DISPLAY=f":{number}", ASAN_OPTIONS="detect_leaks=0")
        self.environment.pop("WAYLAND_DISPLAY", None)
        # A window that is mapped while the manager starts may never be seen.
        self.folder = tempfile.TemporaryDirectory()
        started = pathlib.Path(self.folder.name, "started")
        self.manager = subprocess.Popen(["openbox", "--startup", f"touch {started}"],
                                        env=self.environment, stdout=subprocess.DEVNULL,
                                        stderr=subprocess.DEVNULL)
        wait_for("window manager", started.exists)
        return self

    def __exit__(self, *_):
        self.folder.cleanup()
        for process in (self.manager, self.server):
            process.terminate()
            process.wait()

    def tool(self, *arguments):
        """Runs xdotool; returns its output, or None if it failed."""
        result = subprocess.run(["xdotool", *map(str, arguments)], env=self.environment,
                                capture_output=True, text=True, check=False)
        return result.stdout.strip() if result.returncode == 0 else None


def fly(display, psygen, source, out, *options, stdout=subprocess.PIPE):
    return subprocess.Popen(
        [psygen, "fly", "--world", source / "game/worlds/paper.toml", "--size", "320x180",
         "--view-distance", "130", "--no-vsync", "--validation", "--out", out, *options],
        env=display.environment, stdout=stdout, stderr=subprocess.PIPE, text=True)


def fly_for_an_hour(display, psygen, source, out, *options):
    return fly(display, psygen, source, out, "--path", source / "game/paths/walk27.toml",
               "--seconds", "3600", *options)


def find_window(display):
    return wait_for("window", lambda: display.tool("search", "--onlyvisible", "--name", "psygen")
                    ).split()[0]


def close(display, process):
    """Asks the window to close through the window manager, until the process ends."""
    display.tool("windowactivate", "--sync", find_window(display))

    def ended():
        display.tool("key", "alt+F4")
        return process.poll() is not None

    wait_for("end after closing the window", ended)


def finish(process):
    out, err = process.communicate(timeout=PATIENCE_S)
    assert process.returncode == 0, f"exit code {process.returncode}\n{err}"
    assert "frame" in out, "no summary on stdout"
    return err


def screenshot_in(display, folder):
    """Presses the key, and returns the images."""
    def screenshot():
        display.tool("key", "--window", find_window(display), "F12")
        display.tool("key", "F12")
        return list(folder.glob("screenshot_*.png"))
    return screenshot


def cpu_seconds(process):
    fields = pathlib.Path(f"/proc/{process.pid}/stat").read_text().rsplit(")", 1)[1].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def main():
    processes = []
    try:
        run(processes)
    except AssertionError:
        for process in processes:
            process.kill()
            if process.stderr.closed:
                continue
            print(f"exit code {process.returncode}\n{process.stderr.read()}", file=sys.stderr)
        raise
    finally:
        for process in processes:
            process.kill()


def run(processes):
    psygen, source = sys.argv[1], pathlib.Path(sys.argv[2])
    with Display() as display, tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder)
        process = fly_for_an_hour(display, psygen, source, out)
        processes.append(process)
        window = find_window(display)
        display.tool("windowfocus", "--sync", window)
        for width in range(200, 520, 16):
            display.tool("windowsize", window, width, 460 - width // 2)
        display.tool("windowminimize", "--sync", window)
        # Minimised, a second of real time costs only a little processor time: no busy loop. (The
        # first seconds may still fill the cache.)
        def quiet_second():
            busy, end = cpu_seconds(process), time.monotonic() + 1.0
            while time.monotonic() < end:
                time.sleep(0.05)
            assert process.poll() is None, "ended while minimised"
            return cpu_seconds(process) - busy < 0.5

        wait_for("quiet second while minimised", quiet_second)
        display.tool("windowmap", "--sync", window)
        display.tool("windowactivate", "--sync", window)
        display.tool("windowsize", "--sync", window, 400, 225)

        wait_for("screenshot", screenshot_in(display, out))
        display.tool("key", "--repeat", "10", "w")
        display.tool("key", "Escape")
        wait_for("end after Escape", lambda: process.poll() is not None)
        finish(process)
        assert (out / "summary.json").exists(), "no summary was written"
        with open(out / "frames.csv", encoding="utf-8", newline="") as rows:
            apart = {row["apart"] for row in csv.DictReader(rows)}
        assert apart >= {"resized", "after_idle"}, f"frames are set apart by {apart}"

        out = pathlib.Path(folder, "closed")
        process = fly_for_an_hour(display, psygen, source, out, "--images", "1000000")
        processes.append(process)
        wait_for("first frame", lambda: (out / "frame_00000.png").exists())
        close(display, process)
        finish(process)
        assert (out / "summary.json").exists(), "no summary was written"

        # Closed as soon as there is a window, most probably while it loads.
        process = fly_for_an_hour(display, psygen, source, out)
        processes.append(process)
        close(display, process)
        process.communicate(timeout=PATIENCE_S)
        assert process.returncode == 0, f"exit code {process.returncode}"

        out = pathlib.Path(folder, "short")
        out.mkdir()
        path = out / "path.toml"
        path.write_text(SHORT_PATH, encoding="utf-8")
        printed = out / "stdout"
        with printed.open("w") as stdout:
            process = fly(display, psygen, source, out, "--path", path, "--fixed-step", "30",
                          stdout=stdout)
        processes.append(process)
        # Everything is printed and written when the path ends; the window stays and obeys its keys.
        wait_for("summary", lambda: "memory" in printed.read_text(encoding="utf-8"))
        assert json.loads((out / "summary.json").read_text(encoding="utf-8"))["run"]["frames"] == 15
        display.tool("windowactivate", "--sync", find_window(display))
        wait_for("screenshot after the flight", screenshot_in(display, out))
        assert process.poll() is None, "the window did not stay"
        close(display, process)
        process.communicate(timeout=PATIENCE_S)
        assert process.returncode == 0, f"exit code {process.returncode}"
        assert printed.read_text(encoding="utf-8").count("memory") == 1, "printed twice"
    print("window: resized, minimised, flown, photographed and closed")


if __name__ == "__main__":
    sys.exit(main())
