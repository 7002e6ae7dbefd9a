"""A Wayland display for tests: sway without a screen, with an output HEADLESS-1 of 1280 x 800 pixels, a keyboard and a
mouse. The argument is a layout of xkb (us, de). Prints "ready", XDG_RUNTIME_DIR and WAYLAND_DISPLAY, reads commands from
stdin, a line each, and prints each one when the display has done it:
  move X Y          moves the pointer to a place on the output
  by X Y            moves the pointer by so much
  button CODE 0|1   releases or presses a button (linux/input-event-codes.h)
  key CODE 0|1      releases or presses a key
  sway COMMAND      is for swaymsg
The display ends with stdin. This file speaks Wayland's wire format itself, because Debian has no client for both
virtual-keyboard-unstable-v1 and wlr-virtual-pointer-unstable-v1 that stays connected.
"""
import array
import glob
import os
import pwd
import socket
import struct
import subprocess
import sys
import tempfile
import time


class Connection:
    def __init__(self):
        self.socket = socket.socket(socket.AF_UNIX)
        self.socket.connect(os.path.join(os.environ["XDG_RUNTIME_DIR"], os.environ["WAYLAND_DISPLAY"]))
        self.last_object = 1
        self.globals = {}
        self.registry = self.new_object()
        self.send(1, 1, "I", self.registry)
        self.sync()

    def new_object(self):
        self.last_object += 1
        return self.last_object

    def send(self, target, request, kinds="", *values, file=None):
        body = struct.pack("=" + kinds, *values)
        passed = [] if file is None else [(socket.SOL_SOCKET, socket.SCM_RIGHTS, array.array("i", [file.fileno()]))]
        self.socket.sendmsg([struct.pack("=IHH", target, request, 8 + len(body)) + body], passed)

    def sync(self):
        """Waits until the compositor has handled all requests."""
        done = self.new_object()
        self.send(1, 0, "I", done)
        received = b""
        while True:
            received += self.socket.recv(65536)
            while len(received) >= 8:
                sender, event, size = struct.unpack("=IHH", received[:8])
                if len(received) < size:
                    break
                body, received = received[8:size], received[size:]
                if sender == 1 and event == 0:
                    sys.exit(f"the compositor reports an error: {body!r}")
                if sender == self.registry and event == 0:
                    name, length = struct.unpack("=II", body[:8])
                    self.globals[body[8:8 + length - 1].decode()] = name
                if sender == done:
                    return

    def bind(self, interface):
        if interface not in self.globals:
            sys.exit(f"the compositor has no {interface}")
        text = interface.encode() + b"\0"
        padded = text.ljust((len(text) + 3) // 4 * 4, b"\0")
        made = self.new_object()
        self.send(self.registry, 0, f"II{len(padded)}sII", self.globals[interface], len(text), padded, 1, made)
        return made


def milliseconds():
    return int(time.monotonic() * 1000) & 0xFFFFFFFF


def serve(layout):
    wayland = Connection()
    seat = wayland.bind("wl_seat")
    keyboards = wayland.bind("zwp_virtual_keyboard_manager_v1")
    pointers = wayland.bind("zwlr_virtual_pointer_manager_v1")
    keyboard = wayland.new_object()
    wayland.send(keyboards, 0, "II", seat, keyboard)
    pointer = wayland.new_object()
    wayland.send(pointers, 0, "II", seat, pointer)
    keymap = subprocess.run(["xkbcli", "compile-keymap", "--layout", layout], capture_output=True, check=True)
    with tempfile.TemporaryFile() as file:
        file.write(keymap.stdout + b"\0")
        file.flush()
        wayland.send(keyboard, 0, "II", 1, len(keymap.stdout) + 1, file=file)
        wayland.sync()
    print("ready", os.environ["XDG_RUNTIME_DIR"], os.environ["WAYLAND_DISPLAY"], flush=True)
    for line in sys.stdin:
        command, *values = line.split()
        if command == "sway":
            subprocess.run(["swaymsg", *values], check=True, capture_output=True)
        elif command == "key":
            wayland.send(keyboard, 1, "III", milliseconds(), *map(int, values))
        elif command == "button":
            wayland.send(pointer, 2, "III", milliseconds(), *map(int, values))
        elif command == "by":
            wayland.send(pointer, 0, "Iii", milliseconds(), *(256 * int(value) for value in values))
        elif command == "move":
            wayland.send(pointer, 1, "IIIII", milliseconds(), *map(int, values), 1280, 800)
        else:
            sys.exit(f"no command {command}")
        wayland.send(pointer, 4)  # the end of a group of events
        wayland.sync()
        print(line, end="", flush=True)


def main():
    with tempfile.TemporaryDirectory() as folder:
        configuration = os.path.join(folder, "sway")
        with open(configuration, "w", encoding="utf-8") as file:
            file.write("xwayland disable\noutput HEADLESS-1 resolution 1280x800\ndefault_border none\n")
        os.environ |= {"XDG_RUNTIME_DIR": folder, "WLR_BACKENDS": "headless", "WLR_LIBINPUT_NO_DEVICES": "1",
                       "WLR_RENDERER": "pixman"}
        for variable in ("DISPLAY", "WAYLAND_DISPLAY", "SWAYSOCK"):
            os.environ.pop(variable, None)
        user = {}
        if os.getuid() == 0:  # sway 1.7 (Debian 12) refuses to run as root
            nobody = pwd.getpwnam("nobody")
            os.chown(folder, nobody.pw_uid, nobody.pw_gid)
            user = {"user": nobody.pw_uid, "group": nobody.pw_gid, "extra_groups": []}
        sway = subprocess.Popen(["sway", "-c", configuration], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, **user)
        try:
            while not (sockets := glob.glob(os.path.join(folder, "sway-ipc.*.sock"))):
                if sway.poll() is not None:
                    sys.exit("sway ended")
                time.sleep(0.01)
            os.environ["SWAYSOCK"] = sockets[0]
            displays = [name for name in os.listdir(folder) if name.startswith("wayland-") and "." not in name]
            os.environ["WAYLAND_DISPLAY"] = displays[0]
            serve(sys.argv[1])
        finally:
            sway.terminate()
            sway.wait()


if __name__ == "__main__":
    main()
