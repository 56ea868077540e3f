"""A field in the engine's memory, without a copy."""
import ctypes

import numpy

from . import _api
from .errors import StaleView

_DTYPES = {_api.FLOAT64: numpy.dtype(numpy.float64), _api.INT32: numpy.dtype(numpy.int32)}
_LOCATIONS = {_api.NODE: "node", _api.POINT: "point", _api.CELL: "cell", _api.MESH: "mesh"}


class View:
    """A field as it is now, read-only.

    A view may be kept for as long as one likes: it is good until the engine steps or closes, and raises StaleView from then
    on. What is taken from it (`view.array`, `view[3]`, `numpy.asarray(view)`) are plain arrays of the engine's memory, which
    NumPy cannot take back: while one of them is alive the engine refuses to step with ViewHeld, and its memory stays, even
    if the engine is closed. So no array ever shows memory that is gone. For a copy without conditions: Engine.read.
    """

    def __init__(self, engine, field):
        self._engine = engine
        self._data = field.data
        self.name = field.name.decode()
        self.units = field.units.decode()
        self.standard_name = field.standard_name.decode()
        self.location = _LOCATIONS[field.location]
        self.dtype = _DTYPES[field.type]
        self.shape = tuple(field.shape[:field.rank])
        self.strides = tuple(field.strides[:field.rank])
        self.epoch = field.epoch

    @property
    def stale(self):
        """Whether the engine has stepped or closed since."""
        return self._engine.closed or self._engine.epoch != self.epoch

    @property
    def array(self):
        """The field as a NumPy array: no copy, read-only."""
        if self.stale:
            now = "is closed" if self._engine.closed else f"is at epoch {self._engine.epoch}"
            raise StaleView(f"the view of {self.name} is of epoch {self.epoch} and its engine {now}: take a new view")
        memory = self._memory()
        self._engine._lend(self.name, memory)
        return numpy.ndarray(self.shape, self.dtype, memory, 0, self.strides)

    def _memory(self):
        """The bytes of the field, read-only. Every array made of them has this one as its base."""
        size = 0 if 0 in self.shape else self.dtype.itemsize + sum((n - 1) * s for n, s in zip(self.shape, self.strides))
        memory = (ctypes.c_char * size).from_address(self._data or 0) if size else (ctypes.c_char * 0)()
        memory.engine = self._engine._handle  # whoever holds the memory holds the engine
        return numpy.frombuffer(memoryview(memory).toreadonly(), numpy.uint8)

    def __array__(self, dtype=None, copy=None):
        array = self.array if dtype is None else self.array.astype(dtype, copy=False)
        return array.copy() if copy else array

    def __getitem__(self, key):
        return self.array[key]

    def __len__(self):
        return self.shape[0]

    def __repr__(self):
        state = "stale" if self.stale else f"epoch {self.epoch}"
        return f"<talus.View {self.name} [{self.units}] {self.location} {self.shape}, {state}>"
