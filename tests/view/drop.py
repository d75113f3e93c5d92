# SPDX-License-Identifier: BSD-3-Clause
"""Drops files on a window as a file manager does, by the protocol XDND 5 of X11: drop.py WINDOW FILE ...

Ends once the window has taken them; what it takes is a list of percent-encoded URIs.
"""
import ctypes
import ctypes.util
import os
import sys
import time
import urllib.parse

x11 = ctypes.CDLL(ctypes.util.find_library("X11") or "libX11.so.6")
ulong, pointer = ctypes.c_ulong, ctypes.c_void_p


class ClientMessage(ctypes.Structure):
    _fields_ = [("type", ctypes.c_int), ("serial", ulong), ("send_event", ctypes.c_int), ("display", pointer),
                ("window", ulong), ("message_type", ulong), ("format", ctypes.c_int), ("data", ctypes.c_long * 5)]


class SelectionRequest(ctypes.Structure):
    _fields_ = [("type", ctypes.c_int), ("serial", ulong), ("send_event", ctypes.c_int), ("display", pointer),
                ("owner", ulong), ("requestor", ulong), ("selection", ulong), ("target", ulong), ("property", ulong),
                ("time", ulong)]


class Selection(ctypes.Structure):
    _fields_ = [("type", ctypes.c_int), ("serial", ulong), ("send_event", ctypes.c_int), ("display", pointer),
                ("requestor", ulong), ("selection", ulong), ("target", ulong), ("property", ulong), ("time", ulong)]


class Event(ctypes.Union):
    _fields_ = [("type", ctypes.c_int), ("client", ClientMessage), ("request", SelectionRequest),
                ("selection", Selection), ("pad", ctypes.c_long * 24)]


SELECTION_REQUEST, SELECTION_NOTIFY, CLIENT_MESSAGE = 30, 31, 33  # X.h
PROPERTY_REPLACED, SECONDS = 0, 20.0

x11.XOpenDisplay.restype = pointer
x11.XDefaultRootWindow.restype = x11.XInternAtom.restype = x11.XCreateSimpleWindow.restype = ulong
display = pointer(x11.XOpenDisplay(None))
root = ulong(x11.XDefaultRootWindow(display))


def atom(name):
    return x11.XInternAtom(display, name.encode(), 0)


def send(target, event):
    x11.XSendEvent(display, ulong(target), 0, ctypes.c_long(0), ctypes.byref(event))
    x11.XFlush(display)


def message(target, kind, *data):
    event = Event()
    event.client = ClientMessage(CLIENT_MESSAGE, 0, 1, display, target, atom(kind), 32, (ctypes.c_long * 5)(*data))
    send(target, event)


def answer(request, text):
    """Gives what was asked for by putting it into a property of the window that asked."""
    x11.XChangeProperty(display, ulong(request.requestor), ulong(request.property), ulong(request.target), 8,
                        PROPERTY_REPLACED, text, len(text))
    event = Event()
    event.selection = Selection(SELECTION_NOTIFY, 0, 1, display, request.requestor, request.selection, request.target,
                                request.property, request.time)
    send(request.requestor, event)


def next_event(until):
    while x11.XPending(display) == 0:
        if time.monotonic() > until:
            sys.exit("drop.py: the window did not take the files")
        time.sleep(0.01)
    event = Event()
    x11.XNextEvent(display, ctypes.byref(event))
    return event


def drop(target, names):
    source = x11.XCreateSimpleWindow(display, root, 0, 0, 1, 1, 0, ulong(0), ulong(0))
    text = "".join(f"file://{urllib.parse.quote(os.path.abspath(name))}\r\n" for name in names).encode()
    x11.XSetSelectionOwner(display, ulong(atom("XdndSelection")), ulong(source), ulong(0))
    message(target, "XdndEnter", source, 5 << 24, atom("text/uri-list"), 0, 0)
    message(target, "XdndPosition", source, 0, 300 << 16 | 300, 0, atom("XdndActionCopy"))
    until = time.monotonic() + SECONDS
    while True:
        event = next_event(until)
        if event.type == SELECTION_REQUEST:
            answer(event.request, text)
        elif event.type == CLIENT_MESSAGE and event.client.message_type == atom("XdndStatus"):
            if event.client.data[1] & 1 == 0:
                sys.exit("drop.py: the window refuses files")
            message(target, "XdndDrop", source, 0, 0, 0, 0)
        elif event.type == CLIENT_MESSAGE and event.client.message_type == atom("XdndFinished"):
            return


drop(int(sys.argv[1], 0), sys.argv[2:])
