"""Converts ROS image messages to grey images."""

import numpy

from .. import DataError, decode_grey_image

# Encoding: type of a channel, number of channels, indices of red, green and blue (None: grey).
_ENCODINGS = {
    "mono8": ("u1", 1, None), "8UC1": ("u1", 1, None), "mono16": ("u2", 1, None), "16UC1": ("u2", 1, None),
    "rgb8": ("u1", 3, (0, 1, 2)), "bgr8": ("u1", 3, (2, 1, 0)), "8UC3": ("u1", 3, (2, 1, 0)),
    "rgba8": ("u1", 4, (0, 1, 2)), "bgra8": ("u1", 4, (2, 1, 0)), "8UC4": ("u1", 4, (2, 1, 0)),
    "rgb16": ("u2", 3, (0, 1, 2)), "bgr16": ("u2", 3, (2, 1, 0)),
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
    if colours is None:
        return values[:, :, 0].astype(pixel.newbyteorder("="), copy=False)
    total = sum(weight * values[:, :, colour].astype(numpy.uint32) for weight, colour in zip(_LUMINANCE, colours))
    return ((total + (1 << 14)) >> 15).astype(pixel.newbyteorder("="))


def grey_image(message, name: str = "the image") -> numpy.ndarray:
    """The grey values of a ``sensor_msgs/Image`` or ``CompressedImage``: (height, width), uint8 or uint16.

    Colour is converted to luminance; grey images are views of the message. name: of the image, for error messages.
    Raises DataError for other encodings and for messages that are too short.
    """
    if hasattr(message, "encoding"):
        return _raw_image(message, name)
    return decode_grey_image(bytes(message.data), name)
