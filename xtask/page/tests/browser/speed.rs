//! How long the page's pictures take. Nothing is asserted: `cargo test --release -p limpid-page --test browser speed -- --ignored --nocapture`
//! after `cargo xtask web`, on a machine that does nothing else.

use crate::chromium::{Chromium, Server};
use std::time::{Duration, Instant};

/// Pictures of each kind that are timed, after half as many to warm up.
const COUNT: usize = 8;

/// 64,830 particles: three mirrored copies of the dam break side by side, cut by a plane; about 28 % of the picture.
const PARTICLES: &str = "(async () => {
    const packed = await (await fetch('data/dam_break_20.bgeo')).blob();
    const stream = packed.stream().pipeThrough(new DecompressionStream('gzip'));
    const bytes = new DataView(await new Response(stream).arrayBuffer());
    // A classic BGEO: a head of 41 bytes, the attributes' names, then x, y, z, w and the attributes of each point.
    const count = bytes.getInt32(9), attributes = bytes.getInt32(25);
    let at = 41, words = 4;
    for (let i = 0; i < attributes; i++) {
        at += 2 + bytes.getUint16(at);
        const size = bytes.getUint16(at);
        at += 6 + 4 * size;
        words += size;
    }
    const points = [];
    for (let i = 0; i < count; i++) {
        const [x, y, z] = [0, 4, 8].map((byte) => bytes.getFloat32(at + 4 * words * i + byte));
        for (const tile of [-1, 0, 1]) points.push([x, y, (tile === 0 ? -z : z) + 1.55 * tile]);
    }
    points.sort((a, b) => a[2] - b[2]);
    const file = new DataView(new ArrayBuffer(8 + 12 * 64830));
    file.setUint32(0, 64830, true);
    file.setFloat32(4, 0.025, true);
    points.slice(0, 64830).flat().forEach((value, i) => file.setFloat32(8 + 4 * i, value, true));
    // Frames enough that the next one to play is another, however many are left out.
    for (const frame of [1, 2, 3, 4, 5, 6, 7]) viewer.add(`three_${frame}.pos`, new Uint8Array(file.buffer));
    viewer.open();
})()";

/// Where the camera is, but for its first coordinate.
const CAMERA: &str = "camera-target=[0.0,0.7,-0.1]&camera-eye=[EYE,2.65,5.53]";

/// Ends in another digit than 0, so that addresses have as many.
const EYE: f64 = 3.2501;

/// What is drawn: all as the page begins, and one sheet of spheres.
const KINDS: [(&str, &str); 2] = [("defaults", ""), ("spheres, one sheet", "&anisotropy=%22off%22&layers=%22off%22")];

#[test]
#[ignore = "a measurement"]
fn pictures_take_so_long() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../out/web");
    let server = Server::of(&folder);
    let first = address(KINDS[0].1, EYE);
    let mut page = Chromium::open(&server.address(&format!("?example=none#{first}")), true);
    page.resize(1024, 768);
    page.wait("window.viewer");
    page.run(PARTICLES);
    page.wait("viewer.particles === 64830 && viewer.isSettled");
    println!(
        "first whole picture: {} ms after the page was opened",
        page.text("String(Math.round(performance.now()))")
    );
    for (kind, options) in KINDS {
        page.run("viewer.play(false)");
        println!("{kind}");
        let mut eye = EYE;
        report("  at rest", &mut page, |page| {
            eye += 0.001;
            let begun = Instant::now();
            page.run(&format!("viewer.setFragment('{}')", address(options, eye)));
            page.wait_closely(&format!("viewer.isSettled && viewer.fragment().includes('{eye:.4}')"));
            begun.elapsed()
        });
        let mut x = 300.0;
        page.mouse("Moved", (x, 400.0));
        page.mouse("Pressed", (x, 400.0));
        // What moves less is a click yet.
        x += 20.0;
        page.mouse("Moved", (x, 400.0));
        report("  dragged", &mut page, |page| {
            x += 2.0;
            next_picture(page, |page| page.mouse("Moved", (x, 400.0)))
        });
        page.mouse("Released", (x, 400.0));
        page.wait("viewer.isSettled");
        page.run("viewer.play(true)");
        report("  played", &mut page, |page| next_picture(page, |_| ()));
    }
}

fn address(options: &str, eye: f64) -> String {
    format!("size=%221024x768%22&{}{options}", CAMERA.replace("EYE", &format!("{eye:.4}")))
}

/// From the beginning of one picture, after the last is done, to that of the next, for which something may have to be done.
fn next_picture(page: &mut Chromium, ask: impl Fn(&mut Chromium)) -> Duration {
    let (drawn, begun) = (page.number("viewer.drawn"), Instant::now());
    ask(page);
    page.wait_closely(&format!("viewer.drawn > {drawn}"));
    begun.elapsed()
}

fn report(what: &str, page: &mut Chromium, mut picture: impl FnMut(&mut Chromium) -> Duration) {
    (0..COUNT / 2).for_each(|_| _ = picture(page));
    let before = page.processor_ms();
    let mut times: Vec<f64> = (0..COUNT).map(|_| picture(page).as_secs_f64() * 1000.0).collect();
    times.sort_by(f64::total_cmp);
    let processor = (page.processor_ms() - before) / COUNT as f64;
    let grade = page.text("viewer.grade");
    println!(
        "{what} ({grade}): median {:.0} ms, least {:.0} ms; {processor:.0} ms of processor time each",
        times[COUNT / 2],
        times[0]
    );
}
