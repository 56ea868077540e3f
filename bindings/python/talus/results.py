"""What `talus run` left in a folder: the report, the probes' histories, the fields."""
import base64
import csv
import json
import pathlib
import xml.etree.ElementTree as ElementTree

import numpy

_DTYPES = {"Float64": numpy.float64, "Int32": numpy.int32, "UInt8": numpy.uint8}
_HEADER = 8  # bytes: the data's size, before the data


def _array(element):
    data = base64.b64decode(element.text.strip())
    values = numpy.frombuffer(data, _DTYPES[element.get("type")], offset=_HEADER)
    components = int(element.get("NumberOfComponents"))
    return values if components == 1 else values.reshape(-1, components)


class Fields:
    """The fields of one time: arrays by their names. Positions and vectors have three components, x, y, 0.

    nodes, cells, points   dicts of the fields at each; "position" of nodes and points among them
    corners                the cells' nodes, all in a row; corners[ends[c-1]:ends[c]] are those of cell c
    A dynamic ground has points alone.
    """

    def __init__(self, time, ground_file, points_file):
        self.time = time
        self.nodes, self.cells, self.corners, self.ends = {}, {}, (), ()
        if ground_file is not None:
            self._read_mesh(ground_file)
        piece = ElementTree.parse(points_file).find(".//Piece")
        self.points = {a.get("Name"): _array(a) for a in piece.find("PointData")}
        self.points["position"] = _array(piece.find("Points/DataArray"))

    def _read_mesh(self, ground_file):
        piece = ElementTree.parse(ground_file).find(".//Piece")
        self.nodes = {a.get("Name"): _array(a) for a in piece.find("PointData")}
        self.nodes["position"] = _array(piece.find("Points/DataArray"))
        self.cells = {a.get("Name"): _array(a) for a in piece.find("CellData")}
        mesh = {a.get("Name"): _array(a) for a in piece.find("Cells")}
        self.corners, self.ends = mesh["connectivity"], mesh["offsets"]

    def at_nodes(self, name):
        """A field at the nodes. One of the points is averaged: each cell has a point for each of its corners, in their order."""
        if name in self.nodes:
            return self.nodes[name]
        values, count = self.points[name], len(self.nodes["position"])
        sums = numpy.zeros((count,) + values.shape[1:])
        numpy.add.at(sums, self.corners, values)
        shares = numpy.bincount(self.corners, minlength=count)
        return (sums.T / shares).T


class Results:
    """A run's folder.

    report   what report.json says: a dict
    probes   the columns of probes.csv by their names, "time" and "A.pressure": arrays
    times    of the fields, s
    mesh_times, moving_times   those at which the ground was one of a mesh, and one of points alone, s
    """

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        self.report = json.loads((self.folder / "report.json").read_text())
        self.probes = self._read_probes()
        self._ground, self._points = self._series("ground"), self._series("points")
        self.times = list(self._points)
        self.mesh_times = [time for time in self.times if time in self._ground]
        self.moving_times = [time for time in self.times if time not in self._ground]

    def _read_probes(self):
        path = self.folder / "probes.csv"
        if not path.exists():
            return {}
        with path.open(newline="") as file:
            names, *rows = csv.reader(file)
        return dict(zip(names, numpy.array(rows, float).T))

    def _series(self, name):
        path = self.folder / f"{name}.pvd"
        if not path.exists():
            return {}
        sets = ElementTree.parse(path).iter("DataSet")
        return {float(entry.get("timestep")): self.folder / entry.get("file") for entry in sets}

    def fields(self, time):
        """The fields at one of the times."""
        return Fields(time, self._ground.get(time), self._points[time])

    def steps(self, name):
        """A number of the step reports, one a step."""
        return numpy.array([step[name] for step in self.report["steps"]], float)
