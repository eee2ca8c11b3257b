//! The tiled sets are those of data/README.md, to the bit.

use limpid_bench::Tiled;
use sha2::{Digest, Sha256};

#[test]
fn a_million_and_four_have_the_recorded_bits() {
    let sets = [
        (Tiled { across: 6, deep: 7 }, 1_023_120, "4fdd8aa642e50d16b587e4dfc40dd43bc48dd9a91598b97877dea197faafc983"),
        (Tiled { across: 12, deep: 14 }, 4_092_480, "b66c8341565216722e75fcaa8f31fa4525d1377cfd0d85b566501f084ff9973b"),
    ];
    let tile = Tiled::tile().unwrap();
    for (set, count, expected) in sets {
        assert_eq!(Tiled::holding(count, tile.len()), set);
        let positions: Vec<[f32; 3]> = set.positions(&tile).collect();
        assert_eq!(positions.len(), count);
        // Little-endian, as all that limpid runs on.
        let hash = Sha256::digest(bytemuck::cast_slice::<_, u8>(&positions));
        let hex: String = hash.iter().map(|byte| format!("{byte:02x}")).collect();
        assert_eq!(hex, expected, "{set:?}");
    }
}
