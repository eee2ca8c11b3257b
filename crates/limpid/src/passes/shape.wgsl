// How a ball is stretched: a symmetric matrix of determinant 1 that makes it, from a sphere of its radius, in six halves. Stored
// less the identity: zeros are a sphere, and nearly round shapes keep their digits.

fn pack_shape(shape: mat3x3f) -> vec4u {
    return vec4u(
        pack2x16float(vec2f(shape[0][0], shape[1][1]) - 1.0),
        pack2x16float(vec2f(shape[2][2] - 1.0, shape[0][1])),
        pack2x16float(vec2f(shape[0][2], shape[1][2])),
        0u,
    );
}

fn unpack_shape(packed: vec4u) -> mat3x3f {
    let a = unpack2x16float(packed.x) + 1.0; // xx, yy
    let b = unpack2x16float(packed.y) + vec2f(1.0, 0.0); // zz, xy
    let c = unpack2x16float(packed.z); // xz, yz
    return mat3x3f(a.x, b.y, c.x, b.y, a.y, c.y, c.x, c.y, b.x);
}

fn inverse_of_symmetric(m: mat3x3f) -> mat3x3f {
    let x = cross(m[1], m[2]);
    let y = cross(m[2], m[0]);
    let z = cross(m[0], m[1]);
    return (1.0 / dot(m[0], x)) * mat3x3f(x, y, z);
}
