// Charts: bars are elements that take a share of the page's width, so that they fit a phone; charts with axes
// are drawn anew when their width changes.

const colors = {
    generate: "#7cc36b", intersect: "#56b4e9", shade: "#f2a33a", shadow: "#a892e8",
    count_children: "#d3c04b", sum_children: "#a9b0b8", compact: "#ea8fb5",
};

function element(name, attributes = {}, ...children) {
    const made = document.createElement(name);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    made.append(...children);
    return made;
}

function drawing(name, attributes, text) {
    const made = document.createElementNS("http://www.w3.org/2000/svg", name);
    for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
    if (text !== undefined) made.textContent = text;
    return made;
}

/// Digits behind the point: so many significant ones, or all of a whole number.
function digits(value, significant) {
    if (Number.isInteger(value)) return 0;
    return Math.min(6, Math.max(0, significant - 1 - Math.floor(Math.log10(Math.abs(value)))));
}

function number(value, significant = 4) {
    if (value === null) return "–";
    return value.toLocaleString("en", {
        minimumFractionDigits: digits(value, significant), maximumFractionDigits: digits(value, significant)});
}

/// A part of a bar that stands for `whole`; `data` is kept in it as data-… attributes. Parts that take less
/// than a tenth of the page's width, by `frame`, have no room for a label.
function segment(label, ms, whole, frame, data) {
    const text = `${label}: ${number(ms)} ms, ${number(100 * ms / whole, 3)} %`;
    const part = element("div", {title: text, style: `width: ${100 * ms / whole}%`});
    for (const [key, value] of Object.entries(data)) part.dataset[key] = value;
    part.dataset.ms = ms;
    if (data.kernel) part.style.background = colors[data.kernel] ?? "var(--host)";
    else part.classList.add("host");
    if (data.step === "") part.style.background = "var(--unattributed)";
    if (ms / frame > 0.1) part.append(label);
    return part;
}

function legend(parts) {
    const list = element("ul", {class: "legend"});
    for (const part of parts) {
        const swatch = element("i");
        swatch.className = part.className;
        swatch.style.background = part.style.background;
        list.append(element("li", {}, swatch, part.title));
    }
    return list;
}

/// [{generation, parts: [row]}], by generation.
function byGeneration(rows) {
    const generations = [];
    for (const row of rows) {
        let entry = generations.find(known => known.generation === row.generation);
        if (!entry) generations.push(entry = {generation: row.generation, parts: []});
        entry.parts.push(row);
    }
    return generations.sort((a, b) => a.generation - b.generation);
}

function median(values) {
    const sorted = values.slice().sort((a, b) => a - b);
    const half = sorted.length >> 1;
    return sorted.length % 2 ? sorted[half] : (sorted[half - 1] + sorted[half]) / 2;
}

function drawFrame(target, profile) {
    const sums = new Map();
    for (const row of profile.kernel_totals) sums.set(row.kernel, (sums.get(row.kernel) ?? 0) + row.ms_median);
    const steps = new Set(profile.repetitions.flatMap(repetition => Object.keys(repetition.exposed)));
    const parts = [...sums].map(([kernel, ms]) => [kernel, ms, {kernel}]);
    const host = [...steps].map(step => {
        const ms = median(profile.repetitions.map(repetition => repetition.exposed[step] ?? 0));
        return [step + " (host)", ms, {step}];
    });
    parts.push(...host.sort((a, b) => b[1] - a[1]));
    parts.push(["unattributed", profile.unattributed_ms, {step: ""}]);
    const whole = Math.max(profile.wall_ms, parts.reduce((sum, part) => sum + part[1], 0));
    const segments = parts.map(([label, ms, data]) => segment(label, ms, whole, whole, data));
    target.append(element("div", {class: "bar", role: "img", "aria-label": "Time of a frame by kernel and host step"},
                          ...segments), legend(segments));
}

function drawWaterfall(target, profile) {
    const generations = byGeneration(profile.rows);
    const whole = profile.rows.reduce((sum, row) => sum + row.ms_median, 0);
    const lanes = element("div", {class: "lanes"});
    let start = 0;
    for (const {generation, parts} of generations) {
        const sum = parts.reduce((total, row) => total + row.ms_median, 0);
        const bar = element("div", {class: "bar", style: `margin-left: ${100 * start / whole}%; width: ${100 * sum / whole}%`});
        for (const row of parts) bar.append(segment(row.kernel, row.ms_median, sum, whole, {kernel: row.kernel, generation}));
        lanes.append(element("span", {}, `generation ${generation}`), element("div", {class: "track"}, bar));
        start += sum;
    }
    lanes.append(element("span"), element("div", {class: "axis"}, element("span", {}, "0"),
                                          element("span", {}, `${number(whole)} ms`)));
    target.append(lanes);
}

function drawRays(target, profile) {
    const lanes = element("div", {class: "lanes"});
    const traced = profile.rows.filter(row => row.kernel === "intersect" || row.kernel === "shadow");
    const most = Math.max(1, ...traced.map(row => row.rays_in));
    for (const {generation, parts} of byGeneration(traced)) {
        for (const row of parts) {
            const name = row.kernel === "shadow" ? "shadow rays" : "rays";
            const bar = element("div", {class: "bar"});
            const part = element("div", {style: `width: calc((100% - 9rem) * ${row.rays_in / most}); background: ${colors[row.kernel]}`});
            Object.assign(part.dataset, {kernel: row.kernel, generation, rays: row.rays_in});
            const share = row.survival_percent === null ? "" : ` (${number(row.survival_percent, 3)} %)`;
            bar.append(part, element("em", {}, number(row.rays_in) + share));
            lanes.append(element("span", {}, `${generation} ${name}`), element("div", {class: "track"}, bar));
        }
    }
    target.append(lanes);
}

/// Places on a logarithmic axis.
function logarithmic(low, high, from, to) {
    return value => from + (to - from) * Math.log(value / low) / Math.log(high / low);
}

function powersOfTen(low, high) {
    const powers = [];
    for (let power = Math.ceil(Math.log10(low)); power <= Math.log10(high); ++power) powers.push(10 ** power);
    return powers;
}

function drawRoofline(target, profile) {
    const {bandwidth_gb_per_s: bandwidth, fma_gflop_per_s: peak} = profile.calibration;
    const known = profile.rows.filter(row => row.flop_per_ray > 0 && row.bytes_per_ray > 0 && row.gflop_per_s > 0);
    const points = known.map(row => ({row, x: row.flop_per_ray / row.bytes_per_ray, y: row.gflop_per_s}));
    const width = Math.max(280, target.clientWidth), height = Math.min(420, Math.max(260, width / 2));
    const left = 56, right = 16, top = 24, bottom = 40;
    const ridge = peak / bandwidth;
    const low = Math.min(ridge, ...points.map(point => point.x)) / 4, high = Math.max(ridge, ...points.map(point => point.x)) * 4;
    const least = Math.min(peak / 10, ...points.map(point => point.y)) / 2;
    const most = 2 * Math.max(peak, ...points.map(point => point.y));
    const slope = Math.sqrt(ridge * Math.max(low, least / bandwidth));  // half way up
    const x = logarithmic(low, high, left, width - right), y = logarithmic(least, most, height - bottom, top);
    const svg = drawing("svg", {viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": "Roofline"});
    for (const value of powersOfTen(low, high)) {
        svg.append(drawing("line", {class: "grid", x1: x(value), x2: x(value), y1: top, y2: height - bottom}),
                   drawing("text", {x: x(value), y: height - bottom + 16, "text-anchor": "middle"}, value.toLocaleString("en")));
    }
    for (const value of powersOfTen(least, most)) {
        svg.append(drawing("line", {class: "grid", x1: left, x2: width - right, y1: y(value), y2: y(value)}),
                   drawing("text", {x: left - 6, y: y(value) + 4, "text-anchor": "end"}, value.toLocaleString("en")));
    }
    svg.append(
        drawing("text", {x: left, y: 14}, "GFLOP/s"),
        drawing("text", {x: width - right, y: height - 8, "text-anchor": "end"}, "FLOP per byte"),
        drawing("path", {class: "roof", d: `M${x(Math.max(low, least / bandwidth))},${y(Math.max(least, low * bandwidth))}` +
                                           `L${x(ridge)},${y(peak)}L${x(high)},${y(peak)}`}),
        drawing("text", {x: width - right, y: y(peak) - 6, "text-anchor": "end"}, `${number(peak)} GFLOP/s`),
        drawing("text", {x: x(slope) - 8, y: y(slope * bandwidth) - 4, "text-anchor": "end"}, `${number(bandwidth)} GB/s`));
    for (const {row, x: intensity, y: speed} of points) {
        const circle = drawing("circle", {cx: x(intensity), cy: y(speed), r: 4 + 1.6 * Math.sqrt(row.wall_percent),
                                          fill: colors[row.kernel] ?? "var(--host)", "fill-opacity": 0.85});
        Object.assign(circle.dataset, {kernel: row.kernel, generation: row.generation, intensity, gflop: speed});
        circle.append(drawing("title", {}, `${row.kernel} ${row.variant} generation ${row.generation}: ` +
                                           `${number(speed)} GFLOP/s at ${number(intensity)} FLOP per byte`));
        svg.append(circle);
    }
    const present = Object.keys(colors).filter(kernel => known.some(row => row.kernel === kernel));
    const list = element("ul", {class: "legend"});
    for (const kernel of present) list.append(element("li", {}, element("i", {style: `background: ${colors[kernel]}`}), kernel));
    target.replaceChildren(svg, list);
}

function drawRepetitions(target, profile) {
    const {repetitions} = profile;
    const most = Math.max(...repetitions.map(repetition => repetition.wall_ms));
    const width = Math.max(280, target.clientWidth), height = 160, left = 56, bottom = 22, top = 10;
    const svg = drawing("svg", {viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": "Wall time of each repetition"});
    const x = i => left + (width - left - 12) * (i + 0.5) / repetitions.length;
    const y = ms => height - bottom - (height - bottom - top) * ms / most;
    for (const ms of [0, profile.wall_ms]) {
        svg.append(drawing("line", {class: "grid", x1: left, x2: width, y1: y(ms), y2: y(ms)}),
                   drawing("text", {x: left - 6, y: y(ms) + 4, "text-anchor": "end"}, number(ms, 3)));
    }
    svg.append(drawing("text", {x: left, y: height - 6}, "ms of each frame; line: the median"));
    repetitions.forEach((repetition, i) => {
        const circle = drawing("circle", {cx: x(i), cy: y(repetition.wall_ms), r: 4, fill: colors.intersect});
        if (repetition.outlier) circle.classList.add("outlier");
        circle.dataset.wall = repetition.wall_ms;
        circle.append(drawing("title", {}, `repetition ${i + 1}: ${number(repetition.wall_ms)} ms, of them ` +
                                           `${number(repetition.device_busy_ms)} ms device busy`));
        svg.append(circle);
    });
    target.replaceChildren(svg);
}
