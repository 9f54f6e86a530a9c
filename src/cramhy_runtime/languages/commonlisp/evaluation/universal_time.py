"""Time: universal times, their calendar, and the internal clocks (ANSI 25.1.4).

The time is the kernel's, so in virtual time a program sees the same moments in every run. Where a program names no time zone, it is
that of the machine in wall time and UTC in virtual time. A time zone of Lisp counts hours *west* of Greenwich.
"""

from __future__ import annotations

import time
from fractions import Fraction

from cramhy_runtime import kernel

from cramhy_runtime.lisp_core.conditions import type_error
from cramhy_runtime.lisp_core.data import MultipleValues
from ..files.files import UNIVERSAL_EPOCH
from .process_usage import processor_time

LISP_NAMES = """get-universal-time get-decoded-time decode-universal-time encode-universal-time get-internal-real-time
get-internal-run-time sleep"""
CONSTANTS = {"INTERNAL-TIME-UNITS-PER-SECOND": 1_000_000}
VARIABLES = CONSTANTS

DAY = 86400
CALENDAR = 28 * 1461 * DAY // 4
"""Seconds after which days of the month and of the week fall together again, within a century."""
CYCLE_YEARS, CYCLE_DAYS = 400, 146097
"""After this many years, or days, the Gregorian calendar begins anew; with it, years are kept within what Python's dates can say."""


def get_universal_time():
    """Seconds since 1900, by the kernel's clock."""
    return int(kernel.active().epoch + kernel.now()) + UNIVERSAL_EPOCH


def get_internal_real_time():
    return round(kernel.now() * CONSTANTS["INTERNAL-TIME-UNITS-PER-SECOND"])


def get_internal_run_time():
    return int(processor_time().user * CONSTANTS["INTERNAL-TIME-UNITS-PER-SECOND"])


def _zone(zone):
    if zone is None or zone.__class__ in (int, Fraction) and -24 <= zone <= 24 and (zone * 3600).denominator == 1:
        return zone
    return type_error(zone, "(OR NULL (RATIONAL -24 24))")


def _local_offset(seconds):
    """(seconds west of Greenwich, whether daylight saving time is in force) of the machine at a universal time."""
    if isinstance(kernel.active().clock, kernel.VirtualClock):
        return 0, False
    moment = min(max(seconds - UNIVERSAL_EPOCH, -(2**31)), 2**32)  # the rules of time zones reach no further
    try:
        local = time.localtime(moment)
    except (OSError, OverflowError):  # Windows knows no time before 1970: the calendar is the same after 28 years
        local = time.localtime(moment % CALENDAR)
    return -local.tm_gmtoff, local.tm_isdst > 0


def _calendar():
    import datetime  # takes 2 ms, and a prompt is there without it

    return datetime


def decode_universal_time(universal_time, time_zone=None):
    """``decode-universal-time``: second, minute, hour, date, month, year, day (0 is Monday), daylight saving time, time zone."""
    if universal_time.__class__ is not int or universal_time < 0:
        return type_error(universal_time, "UNSIGNED-BYTE")
    zone = _zone(time_zone)
    if zone is None:
        west, daylight = _local_offset(universal_time)
        zone = Fraction(west + 3600 * daylight, 3600)
        zone = zone.numerator if zone.denominator == 1 else zone
    else:
        west, daylight = int(zone * 3600), False
    days, seconds = divmod(universal_time - west, DAY)
    cycles, day = divmod(days, CYCLE_DAYS)
    date = _calendar().date(1900, 1, 1) + _calendar().timedelta(day)
    return MultipleValues(
        (
            seconds % 60,
            seconds // 60 % 60,
            seconds // 3600,
            date.day,
            date.month,
            date.year + CYCLE_YEARS * cycles,
            days % 7,
            True if daylight else None,
            zone,
        )
    )


def get_decoded_time():
    """``get-decoded-time``: what `decode_universal_time` says of the present."""
    return decode_universal_time(get_universal_time())


def _within(value, low, high):
    if value.__class__ is int and low <= value <= high:
        return value
    return type_error(value, f"(MOD {high + 1})" if low == 0 else f"(INTEGER {low} {high})")


def encode_universal_time(second, minute, hour, date, month, year, time_zone=None):
    """``encode-universal-time``: the universal time. A year below 100 is the nearest to the present; the 31st of a short month is in
    the next one.
    """
    _within(second, 0, 59), _within(minute, 0, 59), _within(hour, 0, 23), _within(date, 1, 31), _within(month, 1, 12)
    if year.__class__ is not int or year < 0:
        return type_error(year, "UNSIGNED-BYTE")
    zone = _zone(time_zone)
    if year < 100:
        present = get_decoded_time()[5]
        year = min((present - present % 100 + century + year for century in (-100, 0, 100)), key=lambda each: (abs(each - present), -each))
    cycles, year_in_cycle = divmod(year - 1900, CYCLE_YEARS)
    first = _calendar().date(1900 + year_in_cycle, month, 1) - _calendar().date(1900, 1, 1)
    local = (first.days + date - 1 + cycles * CYCLE_DAYS) * DAY + hour * 3600 + minute * 60 + second
    # the offset that holds at the time that comes out of it
    result = local + int(zone * 3600) if zone is not None else local + _local_offset(local + _local_offset(local)[0])[0]
    return result if result >= 0 else type_error(result, "UNSIGNED-BYTE")


def sleep(seconds):
    """``cl:sleep``; a task sleeps by the kernel's clock, so it can be evaporated meanwhile."""
    if isinstance(seconds, bool) or not isinstance(seconds, (int, float, Fraction)) or seconds < 0:
        return type_error(seconds, "(OR (SINGLE-FLOAT 0.0) (DOUBLE-FLOAT 0.0d0) (RATIONAL 0))")
    kernel.sleep(float(seconds))
    return None
