//! The symmetric eigenproblem in small code: Householder's reflections to a tridiagonal matrix, then QL with implicit shifts.
//!
//! Reference: H. Bowdler, R. S. Martin, C. Reinsch, J. H. Wilkinson, The QR and QL algorithms for symmetric matrices, Numer.
//! Math. 11 (1968) 293. All loops run down columns, which lie one after the other in memory.

use faer::Mat;

use super::dot;
use crate::order::rising;

/// Turns of one eigenvalue that never are needed: two or three are.
const MOST_TURNS: usize = 60;

/// Rising eigenvalues and their vectors as columns; `None` where the search does not converge.
pub(crate) fn symmetric_eigen(matrix: &Mat<f64>) -> Option<(Vec<f64>, Mat<f64>)> {
    let size = matrix.nrows();
    let mut reflected = Vec::with_capacity(size * size);
    (0..size).for_each(|column| reflected.extend_from_slice(matrix.col_as_slice(column)));
    let (mut diagonal, mut beside, scales) = to_tridiagonal(&mut reflected, size);
    let mut vectors = product_of_reflections(&reflected, &scales, size);
    to_diagonal(&mut diagonal, &mut beside, &mut vectors)?;
    let order = rising(&diagonal);
    let values = order.iter().map(|&index| diagonal[index]).collect();
    Some((values, Mat::from_fn(size, size, |i, j| vectors[order[j] * size + i])))
}

/// The rising eigenvalues alone.
pub(crate) fn symmetric_eigenvalues(matrix: &Mat<f64>) -> Option<Vec<f64>> {
    symmetric_eigen(matrix).map(|(values, _)| values)
}

/// Diagonal and next diagonal of $H_{n-3}\dots H_0AH_0\dots H_{n-3}$, $H_k = 1 - \tau_kv_kv_k^T$, with the $\tau_k$. Reads the lower
/// triangle, and leaves $v_k$ below the diagonal of column `k`.
fn to_tridiagonal(matrix: &mut [f64], size: usize) -> (Vec<f64>, Vec<f64>, Vec<f64>) {
    let (mut diagonal, mut beside, mut scales) = (Vec::new(), Vec::new(), Vec::new());
    let mut image = vec![0.0; size];
    for k in 0..size {
        let (done, rest) = matrix.split_at_mut((k + 1) * size);
        let column = &mut done[k * size + k..];
        diagonal.push(column[0]);
        let normal = &mut column[1..];
        let first = normal.first().copied().unwrap_or(0.0);
        let beyond = normal.get(1..).map_or(0.0, |below| dot(below, below));
        if beyond == 0.0 {
            beside.push(first);
            scales.push(0.0);
            continue;
        }
        let norm = (first * first + beyond).sqrt().copysign(first);
        normal[0] = first + norm;
        let scale = 2.0 / dot(normal, normal);
        beside.push(-norm);
        scales.push(scale);
        // p = A v, then w = tau p - (tau^2 p.v / 2) v, and A less v w' and w v'.
        let image = &mut image[..normal.len()];
        image.fill(0.0);
        for (j, &share) in normal.iter().enumerate() {
            let column = &rest[j * size + k + 1 + j..(j + 1) * size];
            image[j] += column[0] * share + dot(&column[1..], &normal[j + 1..]);
            add(&mut image[j + 1..], share, &column[1..]);
        }
        let half = 0.5 * scale * scale * dot(image, normal);
        image.iter_mut().zip(&*normal).for_each(|(image, share)| *image = scale * *image - half * share);
        for (j, (of_normal, of_image)) in normal.iter().zip(&*image).enumerate() {
            let column = &mut rest[j * size + k + 1 + j..(j + 1) * size];
            for ((value, a), b) in column.iter_mut().zip(&normal[j..]).zip(&image[j..]) {
                *value -= of_image * a + of_normal * b;
            }
        }
    }
    (diagonal, beside, scales)
}

/// $H_0\dots H_{n-3}$, column after column.
fn product_of_reflections(reflected: &[f64], scales: &[f64], size: usize) -> Vec<f64> {
    let mut product = vec![0.0; size * size];
    (0..size).for_each(|i| product[i * size + i] = 1.0);
    for k in (0..size).rev().filter(|&k| scales[k] != 0.0) {
        let normal = &reflected[k * size + k + 1..(k + 1) * size];
        for j in k + 1..size {
            let column = &mut product[j * size + k + 1..(j + 1) * size];
            let share = scales[k] * dot(normal, column);
            add(column, -share, normal);
        }
    }
    product
}

/// Leaves the eigenvalues in the diagonal of a tridiagonal matrix; the columns of `vectors` turn along.
fn to_diagonal(diagonal: &mut [f64], beside: &mut [f64], vectors: &mut [f64]) -> Option<()> {
    let size = diagonal.len();
    for low in 0..size {
        for turn in 0.. {
            let small = |m: &usize| beside[*m].abs() <= f64::EPSILON * (diagonal[*m].abs() + diagonal[*m + 1].abs());
            let high = (low..size - 1).find(small).unwrap_or(size - 1);
            if high == low {
                break;
            }
            // Not a number, which never gets small, ends here too.
            if turn == MOST_TURNS {
                return None;
            }
            let slope = (diagonal[low + 1] - diagonal[low]) / (2.0 * beside[low]);
            let mut g = diagonal[high] - diagonal[low] + beside[low] / (slope + slope.hypot(1.0).copysign(slope));
            let (mut sine, mut cosine, mut shift) = (1.0, 1.0, 0.0);
            let mut parted = false;
            for i in (low..high).rev() {
                let (f, b) = (sine * beside[i], cosine * beside[i]);
                let r = (f * f + g * g).sqrt();
                beside[i + 1] = r;
                if r == 0.0 {
                    diagonal[i + 1] -= shift;
                    parted = true;
                    break;
                }
                (sine, cosine) = (f / r, g / r);
                let start = diagonal[i + 1] - shift;
                let r = (diagonal[i] - start) * sine + 2.0 * cosine * b;
                shift = sine * r;
                diagonal[i + 1] = start + shift;
                g = cosine * r - b;
                let (first, second) = vectors[i * size..(i + 2) * size].split_at_mut(size);
                for (a, b) in first.iter_mut().zip(second) {
                    (*a, *b) = (cosine * *a - sine * *b, sine * *a + cosine * *b);
                }
            }
            if !parted {
                diagonal[low] -= shift;
                beside[low] = g;
            }
            beside[high] = 0.0;
        }
    }
    Some(())
}

fn add(sum: &mut [f64], factor: f64, values: &[f64]) {
    sum.iter_mut().zip(values).for_each(|(sum, value)| *sum += factor * value);
}
