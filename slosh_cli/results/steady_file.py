"""A file that a library may write without ever learning that the disk is full."""

import io
import os
from collections.abc import Callable
from typing import Any, BinaryIO


class SteadyFile(io.RawIOBase):
    """A binary file that takes everything it is given; `trouble` is why the disk did not, None where it did."""

    def __init__(self, file: BinaryIO) -> None:
        self._file = file
        self._place = self._end = 0
        self.trouble: OSError | KeyboardInterrupt | None = None

    def readable(self) -> bool:
        return True

    def writable(self) -> bool:
        return True

    def seekable(self) -> bool:
        return True

    def seek(self, offset: int, whence: int = os.SEEK_SET) -> int:
        self._place = offset + {os.SEEK_SET: 0, os.SEEK_CUR: self._place, os.SEEK_END: self._end}[whence]
        return self._place

    def tell(self) -> int:
        return self._place

    def write(self, data: Any) -> int:
        count = memoryview(data).nbytes
        self._try(lambda: self._file.write(data))
        self._place += count
        self._end = max(self._end, self._place)
        return count

    def readinto(self, buffer: Any) -> int:
        view = memoryview(buffer).cast("B")
        view[:] = bytes(len(view))
        self._try(lambda: self._file.readinto(view))  # type: ignore[attr-defined]
        self._place += len(view)
        return len(view)

    def truncate(self, size: int | None = None) -> int:
        self._end = self._place if size is None else size
        self._try(lambda: self._file.truncate(self._end))
        return self._end

    def flush(self) -> None:
        if not self.closed:
            self._try(self._file.flush)

    def _try(self, action: Callable[[], object]) -> None:
        """Carry `action` out at the present place, unless the disk has refused before."""
        if self.trouble is not None:
            return
        try:
            self._file.seek(self._place)
            action()
        except (OSError, KeyboardInterrupt) as error:  # neither may pass through HDF5
            self.trouble = error
