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
    viewer.add('three.pos', new Uint8Array(file.buffer));
    viewer.open();
})()";

const CAMERA: &str = "size=%221024x768%22&camera-eye=[3.25,2.65,5.53]&camera-target=[0.0,0.7,-0.1]";

#[test]
#[ignore = "a measurement"]
fn pictures_take_so_long() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../out/web");
    let server = Server::of(&folder);
    let mut page = Chromium::open(&server.address(&format!("?example=none#{CAMERA}")), true);
    page.resize(1024, 768);
    page.wait("window.viewer");
    page.run(PARTICLES);
    page.wait("viewer.particles === 64830 && viewer.isSettled");
    println!("first whole picture: {}", page.text("String(Math.round(performance.now()))"));

    report("at rest", &mut page, |page| {
        let eye = next_eye();
        let begun = Instant::now();
        page.run(&format!("viewer.setFragment('{}')", CAMERA.replace("3.25,", &format!("{eye},"))));
        page.wait_closely(&format!("viewer.isSettled && viewer.fragment().includes('{eye}')"));
        begun.elapsed()
    });
    page.mouse("Moved", (300.0, 400.0));
    page.mouse("Pressed", (300.0, 400.0));
    let mut x = 300.0;
    report("dragged", &mut page, |page| {
        let (drawn, begun) = (page.number("viewer.drawn"), Instant::now());
        x += 2.0;
        page.mouse("Moved", (x, 400.0));
        page.wait_closely(&format!("viewer.drawn > {drawn}"));
        begun.elapsed()
    });
    println!("dragged pictures are {}", page.text("viewer.grade"));
    page.mouse("Released", (x, 400.0));
    page.wait("viewer.isSettled");
}

/// Another place of the camera each time, hardly another.
fn next_eye() -> String {
    use std::sync::atomic::{AtomicU32, Ordering};
    static COUNT: AtomicU32 = AtomicU32::new(1);
    format!("3.25{:03}1", COUNT.fetch_add(1, Ordering::Relaxed))
}

fn report(what: &str, page: &mut Chromium, mut picture: impl FnMut(&mut Chromium) -> Duration) {
    (0..COUNT / 2).for_each(|_| _ = picture(page));
    let before = page.processor_ms();
    let mut times: Vec<f64> = (0..COUNT).map(|_| picture(page).as_secs_f64() * 1000.0).collect();
    times.sort_by(f64::total_cmp);
    let processor = (page.processor_ms() - before) / COUNT as f64;
    println!(
        "{what}: median {:.0} ms, least {:.0} ms; {processor:.0} ms of processor time each",
        times[COUNT / 2],
        times[0]
    );
}
