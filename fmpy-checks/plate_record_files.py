"""Accelerances of a damped plate with noise, as files beside a test.toml: modes and shapes from elsewhere in, no crate's code."""

import numpy as np


def write(folder, piece, shapes, zetas, force_places, response, lines, noise, random):
    """`shapes` are (frequencies, deflections of the response place and of each force place, a row a place)."""
    frequencies, deflections = shapes
    omega, natural = 2.0 * np.pi * lines[:, None], 2.0 * np.pi * frequencies
    gain = -(omega**2) / (natural**2 - omega**2 + 2j * zetas * natural * omega)
    # Rigid modes come first, at zero frequency.
    gain[:, :3] = 1.0
    text = ['structure = "mindlin-plate"', "[piece]"] + [f"{key} = {value}" for key, value in piece.items()]
    for number, force in enumerate(force_places):
        value = gain @ (deflections[0] * deflections[1 + number])
        std = noise * np.sqrt(np.mean(np.abs(value) ** 2))
        value = value + std * np.sqrt(0.5) * (random.standard_normal(len(lines)) + 1j * random.standard_normal(len(lines)))
        table = np.column_stack([lines, value.real, value.imag, np.full(len(lines), std**2)])
        name = f"place-{number}.csv"
        np.savetxt(folder / name, table, delimiter=",", header="frequency_hz,real,imag,variance", comments="")
        text += ["[[measurement]]", 'kind = "accelerance"', f'file = "{name}"']
        text += [f"force_at = {list(force)}", f"response_at = {list(response)}"]
    (folder / "test.toml").write_text("\n".join(text) + "\n")
