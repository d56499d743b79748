"""What run.py tells of its measurements: figures, a table, and the pictures side by side."""
import os
import pathlib

import numpy as np
from PIL import Image, ImageDraw

COVERED_LIMIT = 0.01  # of the pixels that people cover; phases half a key off make it 3 %
TILE = (640, 360)
LABEL_HEIGHT = 28
BACKGROUND = (50, 60, 80)


def machine_state():
    model = next((line.split(":")[1].strip() for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines()
                  if line.startswith("model name")), "unknown")
    return {"cpu": model, "cores": len(os.sched_getaffinity(0)), "load_average": list(os.getloadavg())}


def caption(figures):
    """What a table of figures is worth: where and how they were measured."""
    before, after = (figures["machine"][when]["load_average"][0] for when in ("before", "after"))
    mesh = figures["mesh"]["exported"]
    return (f"{figures['outfit']}, {mesh['triangles']:,} triangles, {mesh['vertices']:,} vertices; view {figures['view']}, "
            f"{figures['width']} x {figures['height']}; {figures['rounds']} rounds of {figures['frames']} frames; "
            f"{figures['machine']['before']['cpu']}, {figures['machine']['before']['cores']} cores, "
            f"load {before:.1f} before and {after:.1f} after")


def spread(values):
    least, first, middle, third, most = np.percentile(values, (0, 25, 50, 75, 100))
    return {"min": least, "q1": first, "median": middle, "q3": third, "max": most}


class Report:
    """@param answers per (row, number of people): what each round's process told
    @param ours labels of our rows, in the order of the table's columns
    @param pictures per (row, number of people): the first frame"""

    def __init__(self, answers, ours, pictures, scene):
        self.answers, self.pictures, self.scene = answers, pictures, scene
        self.ours = [label for label in ours if any(row.label == label for row, _ in answers)]
        # A process's frames first become one figure, so that a round is one figure.
        self.rounds = {key: [float(np.median(answer["frame_ms"])) for answer in told] for key, told in answers.items()}
        self.differs = {key: self.coverage(key) for key in answers}

    def reference(self, key):
        """Of what is compared with this row: ours at the same poses, else the first of them."""
        row, count = key
        alike = [other for other in self.answers if other[1] == count and other[0].poses == row.poses]
        return next((other for label in self.ours for other in alike if other[0].label == label), alike[0])

    def mask(self, key):
        return np.asarray(Image.open(self.pictures[key]).convert("RGBA"))[..., 3] > 127

    def coverage(self, key):
        """Share of the picture that people cover, and of those pixels the share that the reference has otherwise."""
        own, other = self.mask(key), self.mask(self.reference(key))
        either = own | other
        return {"covered": float(own.mean()), "differs": float((own != other).sum() / max(1, either.sum()))}

    def ratio(self, key, label):
        """How many times as long a row takes as one of ours at the same poses: of medians, and by round."""
        own = next((other for other in self.answers if other[0].label == label and other[1] == key[1]
                    and other[0].poses == key[0].poses), None)
        if own is None:
            return None
        pairs = list(zip(self.rounds[key], self.rounds[own]))
        return {"to": label, "of_medians": float(np.median(self.rounds[key]) / np.median(self.rounds[own])),
                "of_rounds": spread([theirs / ours for theirs, ours in pairs])}

    def figures(self, machine, settings):
        rows = []
        for key, told in self.answers.items():
            row, count = key
            rows.append({"row": row.label, "order": row.order, "poses": row.poses, "characters": count,
                         "device": told[0]["device"], "triangles": told[0]["triangles"],
                         "frame_ms_of_rounds": self.rounds[key], "frame_ms": spread(self.rounds[key]), **self.differs[key],
                         "ratios": [ratio for label in self.ours if (ratio := self.ratio(key, label))]})
        told = {name: settings[name] for name in ("view", "counts", "rounds", "warm", "frames", "outfit", "clip")}
        return {"schema": "ensemble.peers/1", "machine": machine, **told, "width": self.scene["width"],
                "height": self.scene["height"], "mesh": self.scene["meshes"], "rows": rows}

    def table(self):
        head = ["people", "poses", "drawn by", "index order", "frame, ms", "least to most", "covers otherwise"]
        head += [f"times {label}" for label in self.ours]
        lines = [head, ["---"] * len(head)]
        for key in sorted(self.answers, key=lambda k: (k[1], k[0].poses != "keys")):
            row, count = key
            ms = spread(self.rounds[key])
            cells = [f"{count:,}", row.poses, row.label, row.order or "own", f"{ms['median']:,.1f}",
                     f"{ms['min']:,.1f} to {ms['max']:,.1f}", f"{100 * self.differs[key]['differs']:.3f} %"]
            for label in self.ours:
                ratio = self.ratio(key, label)
                by_round = ratio["of_rounds"] if ratio else {}
                cells.append(f"{ratio['of_medians']:.2f} ({by_round['q1']:.2f} to {by_round['q3']:.2f})" if ratio else "")
            lines.append(cells)
        return "".join(f"| {' | '.join(cells)} |\n" for cells in lines)

    def sheet(self):
        """Per number of people and poses a line of whole pictures, and below it their middles at full size."""
        groups = {}
        for key in self.answers:
            groups.setdefault((key[1], key[0].poses), []).append(key)
        columns = max(len(keys) for keys in groups.values())
        line_height = LABEL_HEIGHT + 2 * TILE[1]
        sheet = Image.new("RGB", (columns * TILE[0], len(groups) * line_height), BACKGROUND)
        for line, (group, keys) in enumerate(sorted(groups.items())):
            for column, key in enumerate(keys):
                self.paste(sheet, key, (column * TILE[0], line * line_height))
        return sheet

    def paste(self, sheet, key, corner):
        whole = Image.new("RGBA", (self.scene["width"], self.scene["height"]), (*BACKGROUND, 255))
        whole.alpha_composite(Image.open(self.pictures[key]).convert("RGBA"))
        label = Image.new("RGB", (TILE[0] // 2, LABEL_HEIGHT // 2), (0, 0, 0))
        ImageDraw.Draw(label).text((3, 1), f"{key[1]} people, {key[0].name()}", fill=(255, 255, 255))
        x, y = corner
        sheet.paste(label.resize((TILE[0], LABEL_HEIGHT)), (x, y))
        sheet.paste(whole.convert("RGB").resize(TILE, Image.Resampling.LANCZOS), (x, y + LABEL_HEIGHT))
        left, top = (whole.width - TILE[0]) // 2, (whole.height - TILE[1]) // 2
        middle = whole.crop((left, top, left + TILE[0], top + TILE[1])).convert("RGB")
        sheet.paste(middle, (x, y + LABEL_HEIGHT + TILE[1]))

    def wrong(self):
        """Lines about rows that did not draw what the others drew."""
        lines = []
        for key, told in self.answers.items():
            row, count = key
            expected = count * self.scene["meshes"]["exported"]["triangles"]
            if any(answer["triangles"] != expected for answer in told):
                lines.append(f"{row.name()}: drew {told[0]['triangles']:,} triangles, not {expected:,}")
            if self.differs[key]["differs"] > COVERED_LIMIT:
                lines.append(f"{row.name()}, {count} people: {100 * self.differs[key]['differs']:.2f} % of the pixels that "
                             "people cover are others than in the reference; look at peers.png")
        return lines
