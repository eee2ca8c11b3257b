//! The arrays of a glTF file, every access checked against what its buffers really hold.

use gltf::Accessor;
use gltf::accessor::DataType;
use gltf::buffer::View;

use crate::error::Fault;

/// The bytes of all buffers.
pub(crate) struct Buffers(pub Vec<Vec<u8>>);

/// Elements of some bytes, one every `stride`.
struct Elements<'a> {
    bytes: &'a [u8],
    stride: usize,
}

impl Buffers {
    /// Floats of `N` components each; integers are scaled to 0..1 or -1..1, as all uses of them in meshes are.
    pub fn floats<const N: usize>(&self, accessor: &Accessor<'_>) -> Result<Vec<[f32; N]>, Fault> {
        let kind = accessor.data_type();
        let mut values = vec![[0.0; N]; self.count(accessor)?];
        self.fill(accessor, N, |index, bytes| {
            let size = size_of(kind);
            values[index] = std::array::from_fn(|component| float(kind, &bytes[component * size..]));
        })?;
        Ok(values)
    }

    /// Whole numbers.
    pub fn integers(&self, accessor: &Accessor<'_>) -> Result<Vec<u32>, Fault> {
        let kind = accessor.data_type();
        let mut values = vec![0; self.count(accessor)?];
        self.fill(accessor, 1, |index, bytes| values[index] = integer(kind, bytes))?;
        Ok(values)
    }

    /// The bytes of a view.
    pub fn view(&self, view: &View<'_>) -> Result<&[u8], Fault> {
        let buffer = self.0.get(view.buffer().index()).map_or(&[][..], Vec::as_slice);
        let end = view.offset().checked_add(view.length());
        end.and_then(|end| buffer.get(view.offset()..end)).ok_or_else(|| {
            let (index, end) = (view.index(), view.offset().saturating_add(view.length()));
            Fault::broken(format!("buffer view {index} ends at byte {end}, its buffer at byte {}", buffer.len()))
        })
    }

    /// How many elements there are. Even zeros that take no room in the file must have a byte each.
    fn count(&self, accessor: &Accessor<'_>) -> Result<usize, Fault> {
        let bytes: usize = self.0.iter().map(Vec::len).sum();
        let count = accessor.count();
        if count > bytes {
            let index = accessor.index();
            return Err(Fault::broken(format!("accessor {index} claims {count} elements of {bytes} bytes")));
        }
        Ok(count)
    }

    /// Hands over the bytes of each element that the file has.
    fn fill(&self, accessor: &Accessor<'_>, components: usize, mut set: impl FnMut(usize, &[u8])) -> Result<(), Fault> {
        let index = accessor.index();
        if accessor.dimensions().multiplicity() != components {
            let found = accessor.dimensions().multiplicity();
            return Err(Fault::broken(format!("accessor {index} has {found} components instead of {components}")));
        }
        let size = components * size_of(accessor.data_type());
        let count = accessor.count();
        if let Some(view) = accessor.view() {
            let elements = self.elements(&view, accessor.offset(), size, count)?;
            (0..count).for_each(|index| set(index, elements.get(index, size)));
        }
        let Some(sparse) = accessor.sparse() else { return Ok(()) };
        let (indices, values) = (sparse.indices(), sparse.values());
        let kind = match indices.index_type() {
            gltf::accessor::sparse::IndexType::U8 => DataType::U8,
            gltf::accessor::sparse::IndexType::U16 => DataType::U16,
            gltf::accessor::sparse::IndexType::U32 => DataType::U32,
        };
        let index_size = size_of(kind);
        let changed = sparse.count();
        let indices = self.elements(&indices.view(), indices.offset(), index_size, changed)?;
        let values = self.elements(&values.view(), values.offset(), size, changed)?;
        for change in 0..changed {
            let target = integer(kind, indices.get(change, index_size)) as usize;
            if target >= count {
                return Err(Fault::broken(format!("accessor {index} changes element {target} of {count}")));
            }
            set(target, values.get(change, size));
        }
        Ok(())
    }

    /// Checks that all elements are there.
    fn elements(&self, view: &View<'_>, offset: usize, size: usize, count: usize) -> Result<Elements<'_>, Fault> {
        let bytes = self.view(view)?;
        let stride = view.stride().unwrap_or(size).max(1);
        let end = count.checked_sub(1).map_or(Some(0), |last| last.checked_mul(stride)?.checked_add(size));
        match end.and_then(|end| end.checked_add(offset)) {
            Some(end) if end <= bytes.len() => Ok(Elements { bytes: bytes.get(offset..).unwrap_or_default(), stride }),
            _ => {
                let (index, length) = (view.index(), bytes.len());
                Err(Fault::broken(format!(
                    "{count} elements of {size} bytes don't fit the {length} of buffer view {index}"
                )))
            }
        }
    }
}

impl<'a> Elements<'a> {
    fn get(&self, index: usize, size: usize) -> &'a [u8] {
        &self.bytes[index * self.stride..][..size]
    }
}

fn size_of(kind: DataType) -> usize {
    match kind {
        DataType::I8 | DataType::U8 => 1,
        DataType::I16 | DataType::U16 => 2,
        DataType::U32 | DataType::F32 => 4,
    }
}

/// The first number of some bytes, which are enough.
fn first<const N: usize>(bytes: &[u8]) -> [u8; N] {
    bytes.first_chunk().copied().unwrap_or([0; N])
}

/// A number; integers are normalized as in section 3.11 of glTF 2.0.
fn float(kind: DataType, bytes: &[u8]) -> f32 {
    match kind {
        DataType::F32 => f32::from_le_bytes(first(bytes)),
        DataType::U8 => f32::from(bytes[0]) / 255.0,
        DataType::U16 => f32::from(u16::from_le_bytes(first(bytes))) / 65535.0,
        DataType::I8 => (f32::from(bytes[0] as i8) / 127.0).max(-1.0),
        DataType::I16 => (f32::from(i16::from_le_bytes(first(bytes))) / 32767.0).max(-1.0),
        DataType::U32 => u32::from_le_bytes(first(bytes)) as f32,
    }
}

fn integer(kind: DataType, bytes: &[u8]) -> u32 {
    match kind {
        DataType::I8 | DataType::U8 => u32::from(bytes[0]),
        DataType::I16 | DataType::U16 => u32::from(u16::from_le_bytes(first(bytes))),
        DataType::U32 | DataType::F32 => u32::from_le_bytes(first(bytes)),
    }
}
