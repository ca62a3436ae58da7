"""One mistake a line: a type checker must find each (test_types.py). Never run."""

import numpy as np
from numpy.typing import NDArray

import hadar_limits as hadar
import hadar_limits.dask as clusters

NU = np.arange(800.0, 1200.0, 20.0)
SCENE = hadar.Scene(NU, 310.15)
array: NDArray[np.float64] = hadar.planck(1000.0, 300.0)
number: float = hadar.planck(NU, 300.0)
hadar.planck("1000", 300.0)
hadar.planck_slope(1000.0)
hadar.brightness_temperature(1000.0, temperature=300.0)
hadar.Scene(NU, 310.15, unknown=["temprature"])
hadar.Scene(NU, 310.15, lightning=[0.5])
hadar.local(NU, NU, "scene")
hadar.nearest(NU, NU, SCENE, proof=1e-6)
hadar.nearest(NU, NU, SCENE).distanc
hadar.matrix([NU], SCENE, by="nearby")
hadar.matrix([NU], SCENE, theads=3)
hadar.over_states(NU, NU, SCENE, 300.0)
hadar.emissivity("skin")
hadar.decompose(NU, [NU], (), NU)
hadar.decompose(NU, [NU], (), NU, counts_per_radiance=1.0, theads=3)
hadar.decompose(NU, [NU], (), NU, counts_per_radiance=1.0, method="mle")
hadar.window_information(NU, 5)
hadar.window_information(NU, cells=["ful"])
hadar.window_information(NU, theads=3)
hadar.size({}, theads=3)
hadar.size({}, by="next")
hadar.size({}, threads="3")
hadar.size(3)
hadar.identify({}, matrx=True)
hadar.identify({}, statistics="poison")
hadar.rule("rule.toml", on=2029)
hadar.range_({}, trials="3")
hadar.simulate({}, statistics="gaussian")
hadar.size({}, progress=lambda done: None)
clusters.decompose(NU, [NU], (), NU, counts_per_radiance=1.0, theads=3)
clusters.window_information(NU, cells=["ful"])
clusters.Axis("target.temperature", 300.0)
