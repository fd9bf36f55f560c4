"""Numbers of a recording in few bits, and arrays end to end; web/source/recording.js reads them."""
import numpy

from cleave_scripts.motion.recording import NO_PART


def join(arrays):
    """Arrays end to end, each at a multiple of its item size because the widest come first."""
    described, blocks, at = [], [], 0
    for name, array in sorted(arrays.items(), key=lambda item: -item[1].dtype.itemsize):
        block = array.tobytes()
        described.append({
            "name": name,
            "type": array.dtype.kind + str(8 * array.dtype.itemsize),
            "first": at,
            "count": array.size
        })
        blocks.append(block)
        at += len(block)
    return described, b"".join(blocks)


def quantized_positions(position):
    """16-bit positions, all axes in one unit; differences from step to step, which compress well."""
    origin = position.min(axis=(0, 1)).astype(float)
    unit = max(float((position.max(axis=(0, 1)) - origin).max()), 1e-6) / 65535
    codes = numpy.rint((position - origin) / unit).astype("<u2")
    return origin, unit, _differences(codes)


def quantized_orientations(orientation):
    """16-bit quaternions. q and -q are the same rotation; the sign is kept, so that steps differ little."""
    return _differences(numpy.rint(orientation * 32767).astype("<i2"))


def _differences(codes):
    return numpy.concatenate([codes[:1], codes[1:] - codes[:-1]])


def part_codes(part):
    """8 bits where the part ids allow it."""
    if part.size == 0 or part[part != NO_PART].max(initial=0) < 255:
        return numpy.where(part == NO_PART, 255, part).astype("u1"), 255
    return part.astype("<u2"), NO_PART


def magnitude_codes(values):
    """8-bit logarithmic codes: 0 for zero, 255 for what is no number, 1..254 from the least to the most."""
    positive = values[numpy.isfinite(values) & (values > 0)]
    least, most = (float(positive.min()), float(positive.max())) if positive.size else (1.0, 1.0)
    most = max(most, least * 1.001)
    scaled = numpy.log(numpy.clip(values, least, most) / least) / numpy.log(most / least)
    codes = numpy.where(values > 0, 1 + numpy.rint(253 * numpy.nan_to_num(scaled)), 0)
    codes = numpy.where(numpy.isfinite(values), codes, 255)
    return {"least": least, "most": most}, codes.astype("u1")
