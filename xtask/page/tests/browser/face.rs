//! The face of limpid for other pages' authors.

use crate::chromium::{Chromium, Server};
use crate::picture::root;

#[test]
fn the_example_draws_an_array_of_particles() {
    let server = Server::of(&root().join("out/web"));
    let mut page = Chromium::open(&server.address("example.html"), true);
    page.wait("window.drawn > 2");
    // Within the frame that it is drawn in: later, the canvas is the screen's.
    let colors = "new Promise((done) => requestAnimationFrame(() => {
        const copy = Object.assign(document.createElement('canvas'), { width: 64, height: 40 });
        const context = copy.getContext('2d');
        context.drawImage(document.getElementById('fluid'), 0, 0, 64, 40);
        const bytes = context.getImageData(0, 0, 64, 40).data;
        const colors = new Set();
        for (let i = 0; i < bytes.length; i += 4) colors.add((bytes[i] << 16) | (bytes[i + 1] << 8) | bytes[i + 2]);
        done(colors.size);
    }))";
    assert!(page.number(colors) > 200.0);
    assert_eq!(page.console_errors(), Vec::<String>::new());
    everything_wrong_is_an_error_of_one_line(&mut page);
    page.lose_device();
    page.wait("document.getElementById('said').textContent.includes('graphics device was lost')");
}

fn everything_wrong_is_an_error_of_one_line(page: &mut Chromium) {
    let said = page.run(
        "(async () => {
            const { Fluid } = await import('./limpid.js');
            const fluid = await Fluid.create(document.createElement('canvas'));
            const wrong = [
                () => fluid.setParticles(new Float32Array(7)),
                () => fluid.setParticles(new Float32Array([0, NaN, 0]), 0.1),
                () => fluid.setCamera(new Float64Array(2), new Float64Array(3)),
                () => fluid.set('fov = 1000'),
                () => fluid.set('no = toml = 1'),
            ];
            return wrong.map((call) => { try { call(); return 'nothing' } catch (error) { return String(error) } });
        })()",
    );
    for said in said.as_array().unwrap() {
        let said = said.as_str().unwrap();
        println!("{said}");
        assert!(said.starts_with("Error: ") && said.lines().count() == 1, "{said}");
    }
}
