// SPDX-License-Identifier: BSD-3-Clause
package ladder_spy;

import java.awt.Color;
import java.awt.Dimension;
import java.awt.Graphics2D;
import javax.swing.Action;
import javax.swing.JDesktopPane;

import ladder_msgs.topology_t;
import lcm.spy.ChannelData;
import lcm.spy.SpyPlugin;

/** lcm-spy plugin: nodes and edges of the topology in two projections; colour by class, brighter and larger where the density is higher. */
public final class TopologyView implements SpyPlugin {
    private static final double NODE_M = 0.008;
    private static final Color EDGE = new Color(70, 76, 92);

    @Override
    public boolean canHandle(long fingerprint) {
        return fingerprint == topology_t.LCM_FINGERPRINT;
    }

    @Override
    public Action getAction(JDesktopPane desktop, ChannelData channel) {
        return LiveView.opener("Topology", desktop, channel, View::new);
    }

    private static final class View extends LiveView {
        View(ChannelData channel) {
            super(channel, 66, new Dimension(1000, 560));
        }

        @Override
        protected void draw(Graphics2D graphics) {
            if (!(channel.last instanceof topology_t)) return;
            final topology_t m = (topology_t) channel.last;
            final double aheadM = Math.max(1.0, Math.min(m.range_max_m, 8.0));
            final Projections view = new Projections(graphics, getWidth(), getHeight(), aheadM, m.p_odom_body_m[2] + 0.5);
            for (int i = 0; i < m.num_edges; ++i) {
                final int a = m.edge_a[i];
                final int b = m.edge_b[i];
                if (Math.min(a, b) < 0 || Math.max(a, b) >= m.num_nodes) continue;
                view.line(m.node_x_m[a], m.node_y_m[a], m.node_z_m[a], m.node_x_m[b], m.node_y_m[b], m.node_z_m[b], EDGE, 1.0);
            }
            for (int i = 0; i < m.num_nodes; ++i) {
                final boolean isDense = m.node_strength[i] > 1.5;
                view.point(m.node_x_m[i], m.node_y_m[i], m.node_z_m[i], colorOf(m.node_class[i], isDense), isDense ? 1.4 * NODE_M : NODE_M);
            }
            graphics.setColor(Color.LIGHT_GRAY);
            graphics.drawString(m.num_nodes + " nodes, " + m.num_edges + " edges; blue wall, green safe ground, orange obstacle, grey unknown", 8, getHeight() - 8);
        }

        private static Color colorOf(byte kind, boolean isDense) {
            final Color color;
            if (kind == topology_t.CLASS_WALL) color = new Color(70, 120, 210);
            else if (kind == topology_t.CLASS_SAFE_GROUND) color = new Color(60, 170, 90);
            else if (kind == topology_t.CLASS_OBSTACLE) color = new Color(220, 130, 50);
            else color = new Color(140, 140, 140);
            return isDense ? color.brighter() : color;
        }
    }
}
