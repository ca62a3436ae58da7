# %% [markdown]
# # Can this camera distinguish a person from a robot?
#
# Run it as a script (`python person_or_robot.py [FOLDER]`) or cell by cell. It needs matplotlib and pandas, and takes some seconds.

# %%
import sys
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import hadar_limits as hadar

out = Path(sys.argv[1] if len(sys.argv) > 1 else ".")

# %% [markdown]
# ## A question, as the command would be asked it
# A scenario is a dict here; a path or the text of a TOML file would do.

# %%
scenario = {
    "title": "Person or robot?",
    "target": {"material": "skin", "temperature": "37 degC", "distance": "30 m"},
    "environment": [{"temperature": "20 degC", "lighting": 0.5}],
    "alternatives": {"materials": ["aluminium", "pmma", "pvc-tape"]},
    "camera": {"preset": "flir-a325sc"},
    "requirement": {"distance": 1.0},
}
answer = hadar.size(scenario)
print(answer.sentence)
print(answer.to_pandas()[["alternative", "distance_nearest", "statistical_distance"]].to_string(index=False))

# %% [markdown]
# ## The same physics on arrays
# What skin at 37 degC sends, and what aluminium sends in the state in which it is most like it.

# %%
nu = np.arange(715.0, 1251.0)  # cm^-1
skin, aluminium = hadar.emissivity("skin", nu), hadar.emissivity("aluminium", nu)
scene = hadar.Scene(nu, temperature=310.15, lighting=[0.5], environment=[293.15])
nearest = hadar.nearest(skin, aluminium, scene)
print(f"{nearest.distance:.3e} per root of a photon, proved from {nearest.lower:.3e};")
print(f"aluminium is most like it at {nearest.temperature - 273.15:.1f} degC, V = {nearest.lighting[0]:.3f}")


def sent(emissivity, temperature, lighting):
    return emissivity * hadar.planck(nu, temperature) + (1 - emissivity) * lighting * hadar.planck(nu, 293.15)


person = sent(skin, 310.15, 0.5)
robot = sent(aluminium, nearest.temperature, nearest.lighting[0])

# %% [markdown]
# ## A heat cube of both, taken apart
# Left half skin, right half aluminium, between 30 and 36 degC, with shot noise.

# %%
bands = np.arange(715.0, 1251.0, 10.0)
library = np.stack([hadar.emissivity(name, bands) for name in ("skin", "aluminium")])
light = hadar.planck(bands, [[293.15]])
truth = np.zeros((60, 80), int)
truth[:, 40:] = 1
temperature = 303.15 + 6 * np.linspace(0, 1, 60)[:, None] * np.ones((60, 80))
e = library[truth]
radiance = e * hadar.planck(bands, temperature[..., None]) + (1 - e) * 0.5 * light[0]
counts = np.random.default_rng(1).poisson(2e-15 * 10.0 * radiance).astype(np.float32)
maps = hadar.decompose(counts, library, light, bands, counts_per_radiance=2e-15)
known = maps.candidates == 1
print(f"{known.mean():.1%} of the pixels are decided, {(maps.material == truth)[known].mean():.1%} of these rightly")

# %%
figure, axes = plt.subplots(2, 2, figsize=(10, 7), layout="constrained")
axes[0, 0].plot(nu, person / 1e18, label="skin, 37 °C")
axes[0, 0].plot(nu, robot / 1e18, label=f"aluminium, {nearest.temperature - 273.15:.0f} °C", linestyle="--")
axes[0, 0].set(xlabel="wavenumber (cm⁻¹)", ylabel="10¹⁸ photons s⁻¹ m⁻² sr⁻¹ per cm⁻¹", title="Most alike")
axes[0, 0].legend()
axes[0, 1].plot(nu, 100 * (robot / person - 1))
axes[0, 1].set(xlabel="wavenumber (cm⁻¹)", ylabel="difference (%)", title="What is left to distinguish them")
image = axes[1, 0].imshow(maps.temperature_k - 273.15, cmap="inferno")
axes[1, 0].set_title("Temperature found (°C)")
figure.colorbar(image, ax=axes[1, 0])
axes[1, 1].imshow(np.where(known, maps.material, np.nan), cmap="coolwarm", vmin=0, vmax=1)
axes[1, 1].set_title("Material found (white: undecided)")
figure.savefig(out / "person_or_robot.png", dpi=120)
print(f"wrote {out / 'person_or_robot.png'}")
