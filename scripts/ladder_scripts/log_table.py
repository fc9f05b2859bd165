# SPDX-License-Identifier: BSD-3-Clause
"""Messages of one channel as rows of a table: one row per message, or one per element of its counted arrays."""

from ladder_scripts import messages


class TableError(Exception):
    """The table that was asked for cannot be made; says why."""


class Table:
    """Columns of one type: numbers and texts; fixed arrays as name_0, name_1, ...; counted arrays only with their count in `per`."""

    def __init__(self, message_type, per=None):
        self._type = message_type
        counted = message_type.find(per) if per else -1
        if per and (counted < 0 or not message_type.arrays_of(counted)):
            counts = [field.name for i, field in enumerate(message_type.fields) if message_type.arrays_of(i)]
            raise TableError(f"{message_type.name} has no counted arrays '{per}'; it has: {', '.join(counts) or 'none'}")
        self._per = per
        self._arrays = [field.name for field in message_type.arrays_of(counted)] if per else []
        self.columns = ["log_utime"] + [name for field in message_type.fields for name in self._names(field)]
        self.columns += ["index"] * bool(per) + self._arrays

    @staticmethod
    def _names(field):
        if field.count_index >= 0:
            return []
        return [f"{field.name}_{i}" for i in range(field.fixed)] if field.is_array else [field.name]

    def rows(self, event):
        values = messages.decode(self._type, event.message)
        common = [event.utime_us]
        for field in self._type.fields:
            if field.count_index < 0:
                common += values[field.name] if field.is_array else [values[field.name]]
        if not self._per:
            yield common
            return
        for index in range(values[self._per]):
            yield common + [index] + [values[name][index] for name in self._arrays]
