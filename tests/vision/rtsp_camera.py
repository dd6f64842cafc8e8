#!/usr/bin/python3
"""An RTSP camera made of GStreamer's server, which repeats the JPEGs of a folder.

rtsp_camera.py FOLDER FPS PORT [h264|jpeg]. Prints the port (0: a free one) and, for each picture,
its number in the folder and when it was handed over, in seconds of CLOCK_MONOTONIC.
Debian: gir1.2-gst-rtsp-server-1.0, gstreamer1.0-plugins-good, for h264 gstreamer1.0-plugins-ugly.
"""
import glob
import os
import sys
import threading
import time

import gi

gi.require_version("Gst", "1.0")
gi.require_version("GstRtspServer", "1.0")
from gi.repository import GLib, Gst, GstRtspServer  # noqa: E402

folder, fps, port = sys.argv[1], float(sys.argv[2]), sys.argv[3]
ENCODER = {
    "jpeg": "jpegenc quality=95 ! rtpjpegpay name=pay0 pt=26",
    "h264": "x264enc tune=zerolatency speed-preset=veryfast bitrate=8000 key-int-max=15 ! "
            "rtph264pay name=pay0 pt=96 config-interval=1",
}[sys.argv[4] if len(sys.argv) > 4 else "jpeg"]
pictures = [open(path, "rb").read() for path in sorted(glob.glob(os.path.join(folder, "*.jpg")))]


def push(source):
    """Hands the pictures over at their rate until nobody takes them."""
    begin, number = time.monotonic(), 0
    while True:
        time.sleep(max(0.0, begin + number / fps - time.monotonic()))
        picture = number % len(pictures)
        handed = time.monotonic()
        if source.emit("push-buffer", Gst.Buffer.new_wrapped(pictures[picture])) != Gst.FlowReturn.OK:
            return
        print(picture, f"{handed:.6f}", flush=True)
        number += 1


class Camera(GstRtspServer.RTSPMediaFactory):
    def do_create_element(self, _):
        return Gst.parse_launch(
            "( appsrc name=source is-live=true format=time do-timestamp=true max-buffers=2 "
            f"caps=image/jpeg,framerate={int(fps)}/1 ! jpegdec ! videoconvert ! "
            f"video/x-raw,format=I420 ! {ENCODER} )")

    def do_configure(self, media):
        source = media.get_element().get_child_by_name("source")
        threading.Thread(target=push, args=(source,), daemon=True).start()


Gst.init(None)
server = GstRtspServer.RTSPServer()
server.set_service(port)
factory = Camera()
factory.set_shared(True)
server.get_mount_points().add_factory("/camera", factory)
server.attach(None)
print("port", server.get_bound_port(), flush=True)
GLib.MainLoop().run()
