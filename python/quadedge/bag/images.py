"""Converts ROS image messages to grey images."""

import numpy

from .. import DataError, decode_grey_image

# Encoding: type of a channel, number of channels, and what they hold: the index of grey or luminance, those of red,
# green and blue, or the colours of a 2 x 2 mosaic.
_ENCODINGS = {
    "mono8": ("u1", 1, 0), "8UC1": ("u1", 1, 0), "mono16": ("u2", 1, 0), "16UC1": ("u2", 1, 0),
    "rgb8": ("u1", 3, (0, 1, 2)), "bgr8": ("u1", 3, (2, 1, 0)), "8UC3": ("u1", 3, (2, 1, 0)),
    "rgba8": ("u1", 4, (0, 1, 2)), "bgra8": ("u1", 4, (2, 1, 0)), "8UC4": ("u1", 4, (2, 1, 0)),
    "rgb16": ("u2", 3, (0, 1, 2)), "bgr16": ("u2", 3, (2, 1, 0)),
    "yuv422": ("u1", 2, 1), "uyvy": ("u1", 2, 1), "yuv422_yuy2": ("u1", 2, 0), "yuyv": ("u1", 2, 0),
    **{f"bayer_{mosaic}{bits}": (f"u{bits // 8}", 1, mosaic)
       for mosaic in ("rggb", "bggr", "gbrg", "grbg") for bits in (8, 16)},
}  # fmt: skip
_LUMINANCE = (9798, 19235, 3735)  # weights of red, green and blue times 2^15 (ITU-R BT.601), as for image files


def _raw_image(message, name: str) -> numpy.ndarray:
    if message.encoding not in _ENCODINGS:
        raise DataError(f"{name}: found the encoding '{message.encoding}', expected one of {', '.join(_ENCODINGS)}")
    kind, channels, colours = _ENCODINGS[message.encoding]
    pixel = numpy.dtype((">" if message.is_bigendian else "<") + kind)
    height, width, step = message.height, message.width, message.step
    data = numpy.ascontiguousarray(message.data).view(numpy.uint8)
    if height < 1 or width < 1 or step < width * channels * pixel.itemsize or data.size < height * step:
        raise DataError(f"{name}: found {data.size} bytes in rows of {step}, expected {width} x {height} pixels of "
                        f"{message.encoding}")
    values = numpy.ndarray((height, width, channels), pixel, data, 0, (step, channels * pixel.itemsize, pixel.itemsize))
    native = pixel.newbyteorder("=")
    if isinstance(colours, int):
        return values[:, :, colours].astype(native, copy=False)
    if isinstance(colours, str):
        planes = [_colour_plane(values[:, :, 0], colours, colour) for colour in "rgb"]
    else:
        planes = [values[:, :, colour].astype(numpy.uint32) for colour in colours]
    total = sum(weight * plane for weight, plane in zip(_LUMINANCE, planes))
    return ((total + (1 << 14)) >> 15).astype(native)


def _weighted_sum(values: numpy.ndarray) -> numpy.ndarray:
    """The sum of 3 x 3 neighbours with the weights 1 2 1; the border is replicated by reflection."""
    padded = numpy.pad(values, 1, mode="reflect")
    rows = padded[:-2] + 2 * padded[1:-1] + padded[2:]
    return rows[:, :-2] + 2 * rows[:, 1:-1] + rows[:, 2:]


def _colour_plane(mosaic: numpy.ndarray, pattern: str, colour: str) -> numpy.ndarray:
    """One colour of a mosaic at every pixel, by bilinear interpolation."""
    height, width = mosaic.shape
    cells = numpy.array([letter == colour for letter in pattern]).reshape(2, 2)
    there = numpy.tile(cells, (height // 2 + 1, width // 2 + 1))[:height, :width].astype(numpy.uint32)
    weights = _weighted_sum(there)
    found = (_weighted_sum(there * mosaic) + weights // 2) // weights
    return numpy.where(there == 1, mosaic, found).astype(numpy.uint32)


def grey_image(message, name: str = "the image") -> numpy.ndarray:
    """The grey values of a ``sensor_msgs/Image`` or ``CompressedImage``: (height, width), uint8 or uint16.

    Colour is converted to luminance; grey images are views of the message. name: of the image, for error messages.
    Raises DataError for other encodings and for messages that are too short.
    """
    if hasattr(message, "encoding"):
        return _raw_image(message, name)
    return decode_grey_image(bytes(message.data), name)
