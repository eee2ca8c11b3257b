//! OpenEXR with float32 channels, the same bytes for the same pixels.

use exr::prelude::*;
use limpid_headless::Aov;
use std::io;

/// What compositing programs call the values: Z is depth, Y a single grey value; all other buffers are colours.
fn channel_names(aov: Aov) -> &'static [&'static str] {
    match (aov, aov.channels()) {
        (Aov::RawDepth | Aov::Depth | Aov::BackDepth | Aov::BeyondDepth, _) => &["Z"],
        (Aov::RawNormal | Aov::Normal, _) => &["X", "Y", "Z"],
        (_, 1) => &["Y"],
        (Aov::Motion, _) => &["u", "v"],
        (_, 3) => &["R", "G", "B"],
        _ => &["R", "G", "B", "A"],
    }
}

/// Writes the image.
pub fn write(file: &mut (impl io::Write + io::Seek), aov: Aov, image: &limpid_headless::Image) -> io::Result<()> {
    write_channels(file, image.size, channels(image, channel_names(aov).iter().map(|name| (*name).to_owned())))
}

/// The layer that a buffer is in a file of several: the channels of the picture itself have no layer's name before them.
pub fn layer_name(aov: Aov) -> Option<&'static str> {
    match aov {
        Aov::Picture => None,
        Aov::Passage => Some("transmittance"),
        // What Nuke calls it.
        Aov::Motion => Some("forward"),
        _ => Some(aov.name()),
    }
}

/// Writes several buffers of one size as layers of one image: `R`, `G`, `B`, `A` of the picture, then `depth.Z`,
/// `normal.X` and so on.
pub fn write_layers(
    file: &mut (impl io::Write + io::Seek),
    layers: &[(Aov, &limpid_headless::Image)],
) -> io::Result<()> {
    let size = layers.first().map_or([1, 1], |(_, image)| image.size);
    let channels = layers.iter().flat_map(|(aov, image)| {
        let names = channel_names(*aov).iter().map(|name| match layer_name(*aov) {
            Some(layer) => format!("{layer}.{name}"),
            None => (*name).to_owned(),
        });
        channels(image, names)
    });
    write_channels(file, size, channels.collect())
}

fn channels(
    image: &limpid_headless::Image,
    names: impl Iterator<Item = String>,
) -> SmallVec<[AnyChannel<FlatSamples>; 4]> {
    let channel = |(index, name): (usize, String)| {
        let samples = image.values.iter().skip(index).step_by(image.channels).copied().collect();
        AnyChannel::new(name.as_str(), FlatSamples::F32(samples))
    };
    names.enumerate().map(channel).collect()
}

fn write_channels(
    file: &mut (impl io::Write + io::Seek),
    size: [u32; 2],
    channels: SmallVec<[AnyChannel<FlatSamples>; 4]>,
) -> io::Result<()> {
    let encoding = Encoding {
        compression: Compression::ZIP16,
        blocks: Blocks::ScanLines,
        // Threads must not decide the order of the blocks.
        line_order: LineOrder::Increasing,
    };
    let size = (size[0] as usize, size[1] as usize);
    let layer = Layer::new(size, LayerAttributes::default(), encoding, AnyChannels::sort(channels));
    Image::from_layer(layer).write().to_buffered(file).map_err(io::Error::other)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Cursor;

    #[test]
    fn channels_come_back_bit_for_bit() {
        let image = limpid_headless::Image {
            size: [2, 40],
            channels: 3,
            values: (0..240).map(|i| if i == 7 { f32::INFINITY } else { i as f32 / 3.0 }).collect(),
        };
        let mut bytes = Cursor::new(Vec::new());
        write(&mut bytes, Aov::Normal, &image).unwrap();
        let mut again = Cursor::new(Vec::new());
        write(&mut again, Aov::Normal, &image).unwrap();
        assert_eq!(bytes.get_ref(), again.get_ref());
        bytes.set_position(0);
        let read = read_all_data_from_buffered(bytes);
        for (index, (name, channel)) in ["X", "Y", "Z"].iter().zip(&read.channel_data.list).enumerate() {
            assert_eq!(channel.name.to_string(), *name);
            let FlatSamples::F32(samples) = &channel.sample_data else { panic!("not float32") };
            let expected: Vec<f32> = image.values.iter().skip(index).step_by(3).copied().collect();
            assert_eq!(*samples, expected);
        }
    }

    fn read_all_data_from_buffered(bytes: Cursor<Vec<u8>>) -> Layer<AnyChannels<FlatSamples>> {
        let image = read().no_deep_data().largest_resolution_level().all_channels().first_valid_layer();
        image.all_attributes().from_buffered(bytes).unwrap().layer_data
    }

    #[test]
    fn every_aov_has_a_name_for_each_channel() {
        for aov in Aov::ALL {
            assert_eq!(channel_names(aov).len(), aov.channels(), "{}", aov.name());
        }
    }
}
