// Tables and the page as a whole.

/// Column: key, heading, what it says. Units stand in the headings.
const measures = [
    ["launches", "launches", "Of a repetition"],
    ["rays_in", "rays in", "Rays that the kernel worked on"],
    ["rays_out", "rays out", "Rays that it left to be worked on"],
    ["survival_percent", "survival %", "Rays out of rays in"],
    ["ms_median", "median ms", "Of the repetitions"],
    ["ms_p95", "p95 ms", "95th percentile of the repetitions"],
    ["wall_percent", "% of wall", "Median of the median frame"],
    ["mrays_per_s", "Mrays/s", "Millions of rays a second"],
    ["ns_per_ray", "ns/ray", "Nanoseconds a ray"],
    ["bytes_per_ray", "bytes/ray", "Declared loads and stores of global memory"],
    ["gb_per_s", "GB/s", "By the declared bytes"],
    ["bandwidth_percent", "% of bandwidth", "Of the measured bandwidth; caches let it pass 100"],
    ["flop_per_ray", "FLOP/ray", "Declared floating-point operations"],
    ["gflop_per_s", "GFLOP/s", "By the declared operations"],
    ["fma_percent", "% of peak", "Of the measured arithmetic peak"],
    ["active_lanes", "active lanes", "Rays over places for rays"],
    ["node_visits_per_ray", "nodes/ray", "Nodes opened over rays"],
    ["leaf_visits_per_ray", "leaf blocks/ray", "Leaf blocks tested over rays"],
    ["queued_to_submit_ms", "queued→submit ms", "Waiting"],
    ["submit_to_start_ms", "submit→start ms", "Waiting, mostly for the launch before"],
    ["gap_ms", "gap ms", "The device was idle before the launch"],
];
const columns = {
    rows: [["kernel", "kernel"], ["variant", "variant"], ["generation", "generation"], ...measures],
    kernel_totals: [["kernel", "kernel"], ["variant", "variant"], ...measures],
    generation_totals: [["generation", "generation"], ...measures],
    host_steps: [["name", "step"], ["phase", "phase"], ["calls", "calls"], ["ms_total", "total ms"], ["ms_exposed", "exposed ms"]],
};

/// Negative, 0 or positive; what is not known comes last in both directions.
function order(a, b, direction) {
    if (a === null || b === null) return (a === null) - (b === null);
    return direction * (typeof a === "string" ? a.localeCompare(b) : a - b);
}

function cell(value) {
    if (typeof value === "string") return element("td", {class: "text", "data-value": value}, value);
    return element("td", {"data-value": value === null ? "" : value}, number(value));
}

/// A table that its headings sort.
function drawTable(target, rows, shown) {
    const body = element("tbody");
    const fill = sorted => body.replaceChildren(
        ...sorted.map(row => element("tr", {}, ...shown.map(([key]) => cell(row[key])))));
    const headings = shown.map(([key, label, meaning]) => {
        const button = element("button", {type: "button", title: meaning ?? label}, label);
        const heading = element("th", {scope: "col", "data-key": key}, button);
        if (rows.length > 0 && typeof rows[0][key] === "string") heading.classList.add("text");
        button.addEventListener("click", () => {
            const direction = heading.getAttribute("aria-sort") === "descending" ? 1 : -1;
            for (const other of headings) other.removeAttribute("aria-sort");
            heading.setAttribute("aria-sort", direction < 0 ? "descending" : "ascending");
            fill(rows.slice().sort((a, b) => order(a[key], b[key], direction)));
        });
        return heading;
    });
    fill(rows);
    target.append(element("table", {}, element("thead", {}, element("tr", {}, ...headings)), body));
}

function drawSummary(target, profile) {
    const traced = profile.kernel_totals.filter(row => row.kernel === "intersect" || row.kernel === "shadow");
    const rays = traced.reduce((sum, row) => sum + row.rays_in, 0);
    const busy = median(profile.repetitions.map(repetition => 100 * repetition.device_busy_ms / repetition.wall_ms));
    const {environment} = profile;
    const outliers = profile.repetitions.filter(repetition => repetition.outlier).length;
    const tiles = [
        ["wall_ms", profile.wall_ms, " ms", "a frame, median"],
        ["mrays_per_s", rays / profile.wall_ms / 1000, " Mrays/s", "rays and shadow rays over wall"],
        ["device_busy_percent", busy, " %", "device busy"],
        ["unattributed_ms", profile.unattributed_ms, " ms", "unattributed"],
        ["compiles_during_render", profile.compiles_during_render, "", "compiles during render"],
        ["overhead_percent", environment.overhead_percent, " %", "overhead of profiling (" +
            `${number(environment.overhead_low_percent, 2)} to ${number(environment.overhead_high_percent, 2)})`],
        ["repetitions", profile.repetitions.length, "", `repetitions, ${outliers} outliers`],
    ];
    for (const [key, value, unit, label] of tiles) {
        target.append(element("div", {class: "tile", "data-key": key, "data-value": value},
                              element("b", {}, number(value), element("small", {}, unit)), element("span", {}, label)));
    }
}

function drawEnvironment(target, profile) {
    const body = element("tbody");
    const facts = {...profile.environment, "bandwidth GB/s": profile.calibration.bandwidth_gb_per_s,
                   "peak GFLOP/s": profile.calibration.fma_gflop_per_s};
    for (const [key, value] of Object.entries(facts)) {
        const text = Array.isArray(value) ? value.join(", ") : value === null ? "–" : String(value);
        body.append(element("tr", {}, element("td", {}, key.replaceAll("_", " ")), element("td", {class: "text wide"}, text)));
    }
    target.append(element("table", {}, body));
}

/// The colours of a map of counts, from 0 to its top, and what its pixels come to.
function mapLegend({sum, most, pixels, top, colors}) {
    const data = {class: "scale", "data-sum": sum, "data-most": most, "data-top": top};
    return element("div", data, element("i", {style: `background: linear-gradient(to right, ${colors.join(", ")})`}),
                   element("span", {}, "0"), element("span", {}, number(top) + (most > top ? " and more" : "")),
                   element("em", {}, `${number(sum / pixels)} a pixel, ${number(most)} at most, ${number(sum)} in all`));
}

function drawPictures(target, images) {
    for (const image of images) {
        const caption = element("figcaption", {}, element("b", {}, image.title));
        if (image.colors) caption.append(mapLegend(image));
        target.append(element("figure", {}, element("img", {src: image.source, alt: image.title}), caption));
    }
    target.parentElement.hidden = images.length === 0;
}

{
    const read = id => JSON.parse(document.getElementById(id).textContent);
    const at = id => document.getElementById(id);
    const profile = read("profile");
    const {environment} = profile;
    document.title = `${environment.scene} – Sahl profile`;
    at("subject").textContent = `${environment.scene}, camera ${environment.camera}, ${environment.width}×${environment.height}, ` +
        `depth ${environment.depth}, ${environment.spp} samples a pixel, on ${environment.device} (${environment.threads} threads)`;
    drawSummary(at("summary"), profile);
    drawFrame(at("frame"), profile);
    drawWaterfall(at("waterfall"), profile);
    drawRays(at("rays"), profile);
    for (const [id, shown] of Object.entries(columns)) drawTable(at(id), profile[id], shown);
    drawPictures(at("pictures"), read("images"));
    drawEnvironment(at("environment"), profile);
    const drawScaled = () => {
        drawRoofline(at("roofline"), profile);
        drawRepetitions(at("repetitions"), profile);
    };
    drawScaled();
    addEventListener("resize", drawScaled);
}
